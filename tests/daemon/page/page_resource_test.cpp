/// Which path of the page has which file, and how it may be kept.

#include "daemon/page/page_resource.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/page/gunzip.hpp"
#include "tests/daemon/page/packed_text.hpp"

namespace fvd {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ResourceAnswer ask(PageResource& page, const std::string& path, bool takes_gzip = true) {
  ResourceRequest request;
  request.path = path;
  request.takes_gzip = takes_gzip;
  return page.get(request);
}

std::map<std::string, std::string> fields_of(const ResourceAnswer& answer) {
  return {answer.fields.begin(), answer.fields.end()};
}

class APage : public ::testing::Test {
 protected:
  const std::string frame_ = test::packed("<html>");
  const std::string script_ = test::packed("run()");
  const std::string icon_ = test::packed("<svg>");
  const std::vector<PageFile> files_{{"/assets/main-1a2b.js", "text/javascript; charset=utf-8", "1a2b", script_},
                                     {"/icon.svg", "image/svg+xml", "3c4d", icon_},
                                     {"/index.html", "text/html; charset=utf-8", "5e6f", frame_}};
  PageResource page_{files_};
};

TEST_F(APage, ShowsItsFrameForEveryView) {
  for (const char* view :
       {"/", "/jobs", "/jobs/20261130-7", "/jobs/a b<script>", "/recipes", "/recipes/groove", "/setup"}) {
    const ResourceAnswer answer = ask(page_, view);
    EXPECT_EQ(answer.status, 200) << view;
    EXPECT_EQ(answer.body, frame_) << view;
    auto fields = fields_of(answer);
    EXPECT_EQ(fields["Content-Type"], "text/html; charset=utf-8");
    EXPECT_EQ(fields["Cache-Control"], "no-cache") << "it names the assets of today";
    EXPECT_EQ(fields["ETag"], "\"5e6f-gz\"");
  }
}

TEST_F(APage, HasNothingElse) {
  for (const char* path :
       {"/index.html", "/assets", "/assets/", "/assets/main.js", "/assets/main-1a2b.js/", "/assets/main-1a2b.js.gz",
        "/assets/../index.html", "/favicon.ico", "/api/v1/events", "/api", "/jobs/../index.html"}) {
    const ResourceAnswer answer = ask(page_, path);
    EXPECT_EQ(answer.status, 404) << path;
    EXPECT_EQ(nlohmann::json::parse(answer.body)["error"], "not_found");
    EXPECT_EQ(fields_of(answer)["Content-Type"], "application/json");
  }
}

TEST_F(APage, TellsByItselfWhatIsMistyped) {
  for (const char* path : {"/jobs/", "/jobs/7/height", "/recipes/", "/recipes/a/b", "/setup/", "/setup/a", "/icon",
                           "/main", "", "//", "/Jobs", "/etc/passwd"}) {
    const ResourceAnswer answer = ask(page_, path);
    EXPECT_EQ(answer.status, 404) << path;
    EXPECT_EQ(answer.body, frame_) << path;
    auto fields = fields_of(answer);
    EXPECT_EQ(fields["Content-Type"], "text/html; charset=utf-8");
    EXPECT_EQ(fields.count("ETag"), 0U) << "it is no version of the frame";
  }
}

TEST_F(APage, LetsItsAssetsBeKept) {
  auto script = fields_of(ask(page_, "/assets/main-1a2b.js"));
  EXPECT_EQ(script["Cache-Control"], "public, max-age=31536000, immutable");
  EXPECT_EQ(script["Content-Type"], "text/javascript; charset=utf-8");
  EXPECT_EQ(fields_of(ask(page_, "/icon.svg"))["Content-Type"], "image/svg+xml");
}

TEST_F(APage, UnpacksForClientsWithoutGzip) {
  const ResourceAnswer packed = ask(page_, "/assets/main-1a2b.js");
  EXPECT_EQ(packed.body, script_);
  EXPECT_EQ(fields_of(packed)["Content-Encoding"], "gzip");
  const ResourceAnswer plain = ask(page_, "/assets/main-1a2b.js", false);
  EXPECT_EQ(plain.body, "run()");
  EXPECT_EQ(fields_of(plain).count("Content-Encoding"), 0U);
  EXPECT_EQ(fields_of(plain)["ETag"], "\"1a2b\"") << "another form has another tag";
  for (const auto* answer : {&packed, &plain}) EXPECT_EQ(fields_of(*answer)["Vary"], "Accept-Encoding");
}

TEST_F(APage, IsForEverybody) { EXPECT_FALSE(page_.needs_view()); }

TEST(NoPage, SaysThatThereIsNone) {
  PageResource page{std::span<const PageFile>{}};
  for (const char* view : {"/", "/jobs/7", "/setup"}) {
    const ResourceAnswer answer = ask(page, view);
    EXPECT_EQ(answer.status, 200);
    EXPECT_THAT(answer.body, HasSubstr("built without its operator page"));
    EXPECT_THAT(answer.body, Not(HasSubstr("style"))) << "none may be inline";
    EXPECT_THAT(answer.body, Not(HasSubstr("script")));
  }
  EXPECT_EQ(ask(page, "/icon.svg").status, 404);
  EXPECT_EQ(ask(page, "/nothing").status, 404);
}

TEST(ThePage, IsInTheProgram) {
  const auto files = page_files();
  if (files.empty()) GTEST_SKIP() << "this build has no page: npm was not found, or failed";
  PageResource page;
  const ResourceAnswer frame = ask(page, "/", false);
  EXPECT_EQ(frame.status, 200);
  for (const PageFile& file : files) {
    EXPECT_FALSE(unpacked(file.packed).empty()) << file.path;
    EXPECT_FALSE(file.tag.empty());
    const bool is_script = file.path.ends_with(".js");
    EXPECT_EQ(is_script, file.type == "text/javascript; charset=utf-8") << file.path;
    if (file.path == "/index.html") continue;
    EXPECT_EQ(ask(page, std::string(file.path)).status, 200) << file.path;
  }
  // What the frame names is there.
  const std::string& html = frame.body;
  int named = 0;
  for (auto at = html.find("/assets/"); at != std::string::npos; at = html.find("/assets/", at + 1)) {
    EXPECT_EQ(ask(page, html.substr(at, html.find('"', at) - at)).status, 200);
    ++named;
  }
  EXPECT_GE(named, 2) << html;
  EXPECT_THAT(html, Not(HasSubstr("<style")));
  EXPECT_THAT(html, Not(HasSubstr("http://"))) << "nothing of others";
}

}  // namespace
}  // namespace fvd
