#pragma once

/// Requests and answers of resources, as the transport makes and reads them.

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "daemon/transport/http_resource.hpp"

namespace fvd::test {

inline ResourceRequest request_of(const std::string& path, const std::map<std::string, std::string>& query = {}) {
  ResourceRequest request;
  request.path = path;
  request.query = query;
  return request;
}

/// The whole body, whoever makes it, of as many bytes as are told.
inline std::string body_of(ResourceAnswer& answer) {
  if (!answer.source) return answer.body;
  EXPECT_TRUE(answer.body.empty());
  std::string body;
  for (std::string piece = answer.source->next(); !piece.empty(); piece = answer.source->next()) {
    EXPECT_LE(piece.size(), 256U << 10U);
    body += piece;
  }
  EXPECT_EQ(body.size(), answer.source_bytes);
  return body;
}

/// The value of a field, which stands there once; empty = it does not.
inline std::string field_of(const ResourceAnswer& answer, const std::string& name) {
  std::string value;
  int times = 0;
  for (const auto& [key, text] : answer.fields) {
    if (key != name) continue;
    value = text;
    ++times;
  }
  EXPECT_LE(times, 1) << name;
  return value;
}

}  // namespace fvd::test
