#include "daemon/page/page_resource.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "daemon/page/gunzip.hpp"
#include "daemon/transport/http_refusal.hpp"

namespace fvd {

namespace {

constexpr std::string_view kFrame = "/index.html";
constexpr std::string_view kAssets = "/assets/";
constexpr std::string_view kIcon = "/icon.svg";

/// As src/app.ts knows them.
bool is_view(std::string_view path) {
  for (const std::string_view view : {"/", "/jobs", "/recipes", "/setup"}) {
    if (path == view) return true;
  }
  for (const std::string_view folder : {"/jobs/", "/recipes/"}) {
    if (!path.starts_with(folder)) continue;
    const std::string_view id = path.substr(folder.size());
    return !id.empty() && id.find('/') == std::string_view::npos;
  }
  return false;
}

/// Whether somebody may have typed it for a view: no file, and nothing that programs ask for.
bool may_be_mistyped(std::string_view path) {
  return path.find('.') == std::string_view::npos && !path.starts_with("/api") && !path.starts_with("/assets");
}

/// No style and no script: none may be inline.
constexpr std::string_view kNoPage = R"(<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>fvd</title></head>
<body>
<h1>fvd runs</h1>
<p>This fvd was built without its operator page: npm was not found when it was built, or FVD_WEB was OFF.
Everything that the page does, fvdctl does too, and programs call POST /api/jsonrpc.</p>
<p>To have the page, install nodejs and npm and build fvd again with -DFVD_WEB=ON.</p>
</body>
</html>
)";

ResourceAnswer missing() {
  ResourceAnswer answer;
  answer.status = 404;
  answer.fields = {{"Content-Type", "application/json"}};
  answer.body = HttpRefusal{404, "not_found", "there is nothing here; the operator page begins at /"}.body();
  return answer;
}

ResourceAnswer no_page() {
  ResourceAnswer answer;
  answer.fields = {{"Content-Type", "text/html; charset=utf-8"}, {"Cache-Control", "no-cache"}};
  answer.body = kNoPage;
  return answer;
}

/// The names of assets say what is in them, so they never change. The frame names them and has to be today's.
std::string_view cache_control(std::string_view path) {
  if (path.starts_with(kAssets)) return "public, max-age=31536000, immutable";
  return path == kIcon ? "public, max-age=86400" : "no-cache";
}

ResourceAnswer found(const PageFile& file, bool takes_gzip) {
  ResourceAnswer answer;
  answer.fields = {{"Content-Type", std::string(file.type)},
                   {"Cache-Control", std::string(cache_control(file.path))},
                   {"ETag", '"' + std::string(file.tag) + (takes_gzip ? "-gz" : "") + '"'},
                   {"Vary", "Accept-Encoding"}};
  if (takes_gzip) answer.fields.emplace_back("Content-Encoding", "gzip");
  answer.body = takes_gzip ? std::string(file.packed) : unpacked(file.packed);
  return answer;
}

}  // namespace

ResourceAnswer PageResource::get(const ResourceRequest& request) {
  const bool wants_view = is_view(request.path);
  if (files_.empty() && wants_view) return no_page();
  const bool is_mistyped = !wants_view && may_be_mistyped(request.path);
  if (!wants_view && !is_mistyped && !request.path.starts_with(kAssets) && request.path != kIcon) return missing();
  const std::string_view path = wants_view || is_mistyped ? kFrame : std::string_view(request.path);
  const auto file =
      std::find_if(files_.begin(), files_.end(), [path](const PageFile& one) { return one.path == path; });
  if (file == files_.end()) return missing();
  ResourceAnswer answer = found(*file, request.takes_gzip);
  if (is_mistyped) {
    // The page says so, with the way back.
    answer.status = 404;
    std::erase_if(answer.fields, [](const auto& field) { return field.first == "ETag"; });
  }
  return answer;
}

}  // namespace fvd
