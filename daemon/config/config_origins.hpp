#pragma once

/// Which document of the configuration each value comes from.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace fvd {

/// The documents in the order in which they are merged (RFC 7396), and what --set put over them.
class ConfigOrigins {
 public:
  void add_document(std::string name, nlohmann::json document) {
    documents_.push_back({std::move(name), std::move(document)});
  }
  /// key: "group.key" of --set.
  void add_override(const std::string& key);

  /// All documents merged, without the overrides: null removes what an earlier document says.
  [[nodiscard]] nlohmann::json merged() const;

  /// Name of the document that the value at the JSON pointer comes from; "--set"; "default" where nobody gave one.
  [[nodiscard]] std::string of(const std::string& pointer) const;

 private:
  struct Document {
    std::string name;
    nlohmann::json content;
  };
  std::vector<Document> documents_;
  std::vector<std::string> overrides_;  // as JSON pointers
};

/// Values as JSON text, one to a line, each with its origin in a comment; the program reads it back as it is.
[[nodiscard]] std::string text_with_origins(const nlohmann::ordered_json& values, const ConfigOrigins& origins);

}  // namespace fvd
