#include "drivers/modbus/modbus_pdu.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace fvd {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint8_t kExceptionBit = 0x80;
constexpr std::size_t kEchoBytes = 5;  // function, address, count or value: what a write's answer repeats

bool is_bits(const ModbusRequest& request) {
  return request.table == ModbusTable::kCoil || request.table == ModbusTable::kDiscrete;
}

std::uint8_t function_of(const ModbusRequest& request) {
  if (!request.writes()) {
    switch (request.table) {
      case ModbusTable::kCoil:
        return 1;
      case ModbusTable::kDiscrete:
        return 2;
      case ModbusTable::kHolding:
        return 3;
      case ModbusTable::kInput:
        return 4;
    }
  }
  const bool single = request.single && request.written.size() == 1;
  if (is_bits(request)) return single ? 5 : 15;
  return single ? 6 : 16;
}

void append_word(std::vector<std::uint8_t>& bytes, unsigned word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFFU));
}

std::uint16_t word_at(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>(unsigned{bytes[at]} << 8U | bytes[at + 1]);
}

void append_bits(std::vector<std::uint8_t>& bytes, const std::vector<std::uint16_t>& bits) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + (bits.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (bits[i] == 0) continue;
    bytes[begin + i / 8] = static_cast<std::uint8_t>(bytes[begin + i / 8] | 1U << (i % 8));
  }
}

PduAnswer judge_read(const ModbusRequest& request, Bytes answer, std::vector<std::uint16_t>& values,
                     std::string& error) {
  const auto count = static_cast<std::size_t>(request.read_count);
  const std::size_t expected = is_bits(request) ? (count + 7) / 8 : 2 * count;
  if (answer.size() < 2 || answer[1] != expected || answer.size() < 2 + expected) {
    error = "an answer of another length";
    return PduAnswer::kNone;
  }
  values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] =
        is_bits(request) ? static_cast<std::uint16_t>(answer[2 + i / 8] >> (i % 8) & 1U) : word_at(answer, 2 + 2 * i);
  }
  return PduAnswer::kOk;
}

PduAnswer judge_exception(int code, std::string& error) {
  constexpr std::array kLater{0x05, 0x06, 0x0A, 0x0B};
  error = exception_text(code);
  return std::find(kLater.begin(), kLater.end(), code) != kLater.end() ? PduAnswer::kLater : PduAnswer::kException;
}

}  // namespace

std::vector<std::uint8_t> request_pdu(const ModbusRequest& request) {
  std::vector<std::uint8_t> pdu{function_of(request)};
  append_word(pdu, static_cast<unsigned>(request.address));
  if (!request.writes()) {
    append_word(pdu, static_cast<unsigned>(request.read_count));
    return pdu;
  }
  if (pdu[0] == 5) {
    append_word(pdu, request.written[0] != 0 ? 0xFF00U : 0U);
    return pdu;
  }
  if (pdu[0] == 6) {
    append_word(pdu, request.written[0]);
    return pdu;
  }
  append_word(pdu, static_cast<unsigned>(request.written.size()));
  const std::size_t bytes = is_bits(request) ? (request.written.size() + 7) / 8 : 2 * request.written.size();
  pdu.push_back(static_cast<std::uint8_t>(bytes));
  if (is_bits(request)) {
    append_bits(pdu, request.written);
  } else {
    for (const std::uint16_t word : request.written) append_word(pdu, word);
  }
  return pdu;
}

PduAnswer judge_answer(const ModbusRequest& request, Bytes sent, Bytes answer, std::vector<std::uint16_t>& values,
                       std::string& error) {
  values.clear();
  if (answer.size() >= 2 && answer[0] == (sent[0] | kExceptionBit)) return judge_exception(answer[1], error);
  if (answer.empty() || answer[0] != sent[0]) {
    error = "an answer to another function";
    return PduAnswer::kNone;
  }
  if (!request.writes()) return judge_read(request, answer, values, error);
  if (answer.size() >= kEchoBytes && std::equal(sent.begin(), sent.begin() + kEchoBytes, answer.begin())) {
    return PduAnswer::kOk;
  }
  error = "an answer to another write";
  return PduAnswer::kNone;
}

std::string exception_text(int code) {
  static constexpr std::array<const char*, 12> kTexts{"",
                                                      "illegal function",
                                                      "illegal data address",
                                                      "illegal data value",
                                                      "device failure",
                                                      "acknowledge, it is still at it",
                                                      "busy",
                                                      "negative acknowledge",
                                                      "memory parity error",
                                                      "of the maker's own",
                                                      "the gateway has no path to it",
                                                      "the gateway has no answer from it"};
  std::ostringstream text;
  text << "exception " << code << ": ";
  const bool known = code > 0 && code < static_cast<int>(kTexts.size());
  text << (known ? kTexts[static_cast<std::size_t>(code)] : "of the maker's own");
  return text.str();
}

}  // namespace fvd
