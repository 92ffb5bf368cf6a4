#include "daemon/events/topic_documents.hpp"

#include <initializer_list>

#include "daemon/api/json_shapes.hpp"
#include "daemon/api/list_shapes.hpp"
#include "daemon/api/methods/methods.hpp"

namespace fvd {

namespace {

std::string text_of(const nlohmann::ordered_json& document) {
  return document.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}

Reply without(Reply document, std::initializer_list<const char*> keys) {
  for (const char* key : keys) document.erase(key);
  return document;
}

/// What is told at once of a device: that it is there, that it was lost, that it stands.
Reply presence_of(const Reply& health, const char* device) {
  const Reply& all = health.at(device);
  Reply told{{"open", all.at("open")}, {"openings", all.at("openings")}};
  if (all.contains("standstill")) told["standstill"] = all.at("standstill");
  return told;
}

}  // namespace

TopicDocuments::TopicDocuments(const Services& services) : services_(services) {
  add_health_methods(methods_, services_);
  add_access_methods(methods_, services_);
}

Reply TopicDocuments::told_by(const std::string& method) const {
  const nlohmann::json no_params = nlohmann::json::object();
  const Caller nobody;
  return std::get<Reply>(methods_.at(method).peek({nobody, method, no_params}).value());
}

TopicDocument TopicDocuments::state(const MachineStatus& machine) const {
  const auto up = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - started_);
  const Reply all = machine_status_json(machine, kDefaultClient, up.count());
  const std::string compared = text_of(without(all, {"hb"}));
  return {text_of(all), compared, compared};
}

TopicDocument TopicDocuments::job(const MachineStatus& machine) const {
  if (!machine.job) return {"null", "null", "null"};
  const Reply all = job_status_json(*machine.job);
  return {text_of(all), text_of(without(all, {"age_s"})),
          text_of(without(all, {"age_s", "progress", "slices_done", "frames_expected", "frames_ok"}))};
}

TopicDocument TopicDocuments::control() const {
  // First what is compared: where somebody takes control between the two, the next look tells him.
  const auto holder = services_.control.holder();
  const std::string compared =
      holder ? holder->owner + "\n" + holder->who + "\n" + std::to_string(holder->until.time_since_epoch().count())
             : "";
  return {text_of(told_by("control.state")), compared, compared};
}

TopicDocument TopicDocuments::health() const {
  const Reply all = told_by("system.health");
  const std::string text = text_of(all);
  return {text, text,
          text_of({{"ok", all.at("ok")},
                   {"stalled_threads", all.at("stalled_threads")},
                   {"camera", presence_of(all, "camera")},
                   {"stage", presence_of(all, "stage")}})};
}

TopicDocument TopicDocuments::alarms() const {
  const std::string text = text_of(alarms_json(services_.alarms.newest()));
  return {text, text, ""};
}

}  // namespace fvd
