#include "daemon/ctl/study_text.hpp"

#include <cstdio>

#include "daemon/ctl/exit_codes.hpp"

namespace fvd::ctl {

namespace {

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text + "  ";
}

std::string number_text(const Json& object, const char* key) {
  if (!object.contains(key) || !object[key].is_number()) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", object[key].get<double>());
  return text;
}

std::string text_of(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : std::string();
}

std::string figure_line(const Json& figure) {
  constexpr std::size_t kName = 26;
  constexpr std::size_t kNumber = 12;
  std::string line = padded(text_of(figure, "name"), kName);
  if (const std::string reason = text_of(figure, "reason"); !reason.empty()) return line + "-  " + reason + "\n";
  line += padded(number_text(figure, "value"), kNumber);
  const std::string unit = text_of(figure, "unit");
  line += padded(unit == "1" ? "" : unit, 6);
  if (figure.contains("U")) line += "U " + number_text(figure, "U") + "  k " + number_text(figure, "k");
  while (line.back() == ' ') line.pop_back();
  return line + "\n";
}

std::string notes(const Json& study, const char* key, const char* word) {
  std::string lines;
  for (const Json& note : study.value(key, Json::array())) lines += padded(word, 8) + text_of(note, "text") + "\n";
  return lines;
}

}  // namespace

std::string study_text(const Json& reply) {
  const Json study = reply.value("study", Json::object());
  std::string text;
  if (study.value("simulated", false)) text += "SIMULATED\n";
  for (const Json& figure : study.value("figures", Json::array())) text += figure_line(figure);
  text += notes(study, "refusals", "refused");
  text += notes(study, "warnings", "warning");
  if (!reply.value("kept", true)) return text + "nothing is kept: the study is of folders, without a daemon\n";
  text += padded("study", 8) + text_of(study, "id") + "\n";
  text += padded("report", 8) + text_of(reply, "report") + "\n";
  if (study.contains("proposal")) {
    text += "The constants are proposed, not valid: fvdctl calibrate accept " + text_of(study, "id") +
            " --person NAME --renew-by DATE\n";
  }
  return text;
}

std::string study_list_text(const Json& reply) {
  std::string text;
  for (const Json& study : reply.value("studies", Json::array())) {
    text += padded(text_of(study, "id"), 10) + padded(text_of(study, "kind"), 18) + padded(text_of(study, "time"), 24) +
            padded(text_of(study, "recipe"), 16);
    if (study.contains("calibration")) {
      text += study["calibration"].is_string() ? "accepted as " + text_of(study, "calibration") : "proposed";
    }
    while (text.back() == ' ') text.pop_back();
    text += "\n";
  }
  for (const Json& broken : reply.value("broken", Json::array())) {
    text += padded(text_of(broken, "id"), 10) + "cannot be read: " + text_of(broken, "reason") + "\n";
  }
  return text;
}

int study_exit_code(const Json& reply) {
  for (const Json& warning : reply.value("study", Json::object()).value("warnings", Json::array())) {
    const std::string code = text_of(warning, "code");
    if (code == "not_capable" || code == "system_not_capable" || code == "process_not_capable") return kExitVerdictFail;
  }
  return kExitOk;
}

}  // namespace fvd::ctl
