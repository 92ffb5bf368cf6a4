#include "sim/modbus/modbus_responder.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace fvd::sim {

namespace {

constexpr int kMaxReadBits = 2000;
constexpr int kMaxWriteBits = 1968;
constexpr int kMaxRead = 125;
constexpr int kMaxWrite = 123;
constexpr int kMaxReadWriteWrite = 121;
constexpr int kAddresses = 0x10000;

namespace fc {
constexpr std::uint8_t kReadCoils = 1;
constexpr std::uint8_t kReadDiscreteInputs = 2;
constexpr std::uint8_t kReadHolding = 3;
constexpr std::uint8_t kReadInput = 4;
constexpr std::uint8_t kWriteCoil = 5;
constexpr std::uint8_t kWriteRegister = 6;
constexpr std::uint8_t kDiagnostics = 8;
constexpr std::uint8_t kWriteCoils = 15;
constexpr std::uint8_t kWriteRegisters = 16;
constexpr std::uint8_t kReadWriteRegisters = 23;
constexpr std::uint8_t kEncapsulated = 43;
}  // namespace fc

/// What function code 43 wraps here.
constexpr std::uint8_t kReadIdentification = 14;

using Pdu = std::span<const std::uint8_t>;

std::uint16_t word_at(Pdu pdu, std::size_t at) { return static_cast<std::uint16_t>((pdu[at] << 8U) | pdu[at + 1]); }

void append_word(ModbusBytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
}

ModbusBytes exception_reply(std::uint8_t function, ModbusException exception) {
  return {static_cast<std::uint8_t>(function | 0x80U), static_cast<std::uint8_t>(exception)};
}

ModbusBytes malformed(std::uint8_t function) { return exception_reply(function, ModbusException::kIllegalValue); }

bool runs_over(int address, int count) { return address + count > kAddresses; }

/// The first bytes of a write's request are its reply.
ModbusBytes echo(Pdu pdu) { return {pdu.begin(), pdu.begin() + 5}; }

ModbusBytes read_registers(RegisterBank& bank, std::uint8_t function, int address, int count) {
  if (count < 1 || count > kMaxRead) return malformed(function);
  if (runs_over(address, count)) return exception_reply(function, ModbusException::kIllegalAddress);
  std::vector<std::uint16_t> values(static_cast<std::size_t>(count));
  const auto exception = bank.read(address, values);
  if (exception != ModbusException::kNone) return exception_reply(function, exception);
  ModbusBytes reply{function, static_cast<std::uint8_t>(2 * count)};
  for (const auto value : values) append_word(reply, value);
  return reply;
}

ModbusBytes read_bits(RegisterBank& bank, std::uint8_t function, int address, int count) {
  if (count < 1 || count > kMaxReadBits) return malformed(function);
  if (runs_over(address, count)) return exception_reply(function, ModbusException::kIllegalAddress);
  std::vector<std::uint8_t> bits(static_cast<std::size_t>(count));
  const auto exception = bank.read_bits(address, bits);
  if (exception != ModbusException::kNone) return exception_reply(function, exception);
  ModbusBytes reply(2 + (bits.size() + 7) / 8);
  reply[0] = function;
  reply[1] = static_cast<std::uint8_t>(reply.size() - 2);
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (bits[i] != 0) reply[2 + i / 8] = static_cast<std::uint8_t>(reply[2 + i / 8] | (1U << (i % 8)));
  }
  return reply;
}

ModbusBytes write_coil(RegisterBank& bank, Pdu pdu) {
  const std::uint16_t value = word_at(pdu, 3);
  if (value != 0x0000 && value != 0xFF00) return malformed(fc::kWriteCoil);
  const std::uint8_t bit = value != 0 ? 1 : 0;
  const auto exception = bank.write_bits(word_at(pdu, 1), std::span(&bit, 1));
  return exception == ModbusException::kNone ? echo(pdu) : exception_reply(fc::kWriteCoil, exception);
}

ModbusBytes write_register(RegisterBank& bank, Pdu pdu) {
  const std::uint16_t value = word_at(pdu, 3);
  const auto exception = bank.write(word_at(pdu, 1), std::span(&value, 1));
  return exception == ModbusException::kNone ? echo(pdu) : exception_reply(fc::kWriteRegister, exception);
}

ModbusBytes write_coils(RegisterBank& bank, Pdu pdu) {
  if (pdu.size() < 7) return malformed(fc::kWriteCoils);
  const int count = word_at(pdu, 3);
  const auto bytes = static_cast<std::size_t>((count + 7) / 8);
  if (count < 1 || count > kMaxWriteBits || pdu[5] != bytes || pdu.size() != 6 + bytes) {
    return malformed(fc::kWriteCoils);
  }
  if (runs_over(word_at(pdu, 1), count)) return exception_reply(fc::kWriteCoils, ModbusException::kIllegalAddress);
  std::vector<std::uint8_t> bits(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = static_cast<std::uint8_t>((pdu[6 + i / 8] >> (i % 8)) & 1U);
  const auto exception = bank.write_bits(word_at(pdu, 1), bits);
  return exception == ModbusException::kNone ? echo(pdu) : exception_reply(fc::kWriteCoils, exception);
}

/// The registers of a write whose byte count stands at `at`; empty if the counts disagree.
std::vector<std::uint16_t> words(Pdu pdu, std::size_t at, int count, int max) {
  std::vector<std::uint16_t> values;
  const auto bytes = 2 * static_cast<std::size_t>(std::max(count, 0));
  if (count < 1 || count > max || pdu.size() != at + 1 + bytes || pdu[at] != bytes) return values;
  for (std::size_t i = at + 1; i < pdu.size(); i += 2) values.push_back(word_at(pdu, i));
  return values;
}

ModbusBytes write_registers(RegisterBank& bank, Pdu pdu) {
  if (pdu.size() < 6) return malformed(fc::kWriteRegisters);
  const auto values = words(pdu, 5, word_at(pdu, 3), kMaxWrite);
  if (values.empty()) return malformed(fc::kWriteRegisters);
  if (runs_over(word_at(pdu, 1), word_at(pdu, 3))) {
    return exception_reply(fc::kWriteRegisters, ModbusException::kIllegalAddress);
  }
  const auto exception = bank.write(word_at(pdu, 1), values);
  return exception == ModbusException::kNone ? echo(pdu) : exception_reply(fc::kWriteRegisters, exception);
}

ModbusBytes read_write_registers(RegisterBank& bank, Pdu pdu) {
  constexpr std::uint8_t kFunction = fc::kReadWriteRegisters;
  if (pdu.size() < 10) return malformed(kFunction);
  const int read_count = word_at(pdu, 3);
  const auto values = words(pdu, 9, word_at(pdu, 7), kMaxReadWriteWrite);
  if (values.empty() || read_count < 1 || read_count > kMaxRead) return malformed(kFunction);
  if (runs_over(word_at(pdu, 1), read_count) || runs_over(word_at(pdu, 5), word_at(pdu, 7))) {
    return exception_reply(kFunction, ModbusException::kIllegalAddress);
  }
  const auto exception = bank.write(word_at(pdu, 5), values);
  if (exception != ModbusException::kNone) return exception_reply(kFunction, exception);
  return read_registers(bank, kFunction, word_at(pdu, 1), read_count);
}

/// Hands the query back, which shows that the line works; the other subfunctions are of counters that are not kept.
ModbusBytes diagnose(Pdu pdu) {
  if (pdu.size() < 5 || pdu.size() % 2 == 0) return malformed(fc::kDiagnostics);
  if (word_at(pdu, 1) != 0) return exception_reply(fc::kDiagnostics, ModbusException::kIllegalFunction);
  return {pdu.begin(), pdu.end()};
}

ModbusBytes identify(const RegisterBank& bank, Pdu pdu) {
  constexpr std::uint8_t kFunction = fc::kEncapsulated;
  constexpr std::uint8_t kIndividual = 4;
  constexpr std::uint8_t kBasicAndIndividual = 0x81;  // how much there is, and in which ways it can be read
  const auto identity = bank.identification();
  if (!identity || (pdu.size() >= 2 && pdu[1] != kReadIdentification)) {
    return exception_reply(kFunction, ModbusException::kIllegalFunction);
  }
  if (pdu.size() != 4 || pdu[2] < 1 || pdu[2] > kIndividual) return malformed(kFunction);
  const std::array<const std::string*, 3> objects{&identity->vendor, &identity->product, &identity->revision};
  std::size_t first = pdu[3];
  std::size_t end = objects.size();
  if (pdu[2] == kIndividual) {
    if (first >= objects.size()) return exception_reply(kFunction, ModbusException::kIllegalAddress);
    end = first + 1;
  } else if (first >= objects.size()) {
    first = 0;  // as the standard wants it of a list
  }
  ModbusBytes reply{
      kFunction, kReadIdentification, pdu[2], kBasicAndIndividual, 0, 0, static_cast<std::uint8_t>(end - first)};
  for (std::size_t i = first; i < end; ++i) {
    reply.push_back(static_cast<std::uint8_t>(i));
    reply.push_back(static_cast<std::uint8_t>(objects[i]->size()));
    reply.insert(reply.end(), objects[i]->begin(), objects[i]->end());
  }
  return reply;
}

}  // namespace

ModbusBytes respond(RegisterBank& bank, Pdu request) {
  if (request.empty()) return {};
  const std::uint8_t function = request[0];
  const bool wrong_length = request.size() != 5;
  switch (function) {
    case fc::kReadCoils:
    case fc::kReadDiscreteInputs:
      return wrong_length ? malformed(function) : read_bits(bank, function, word_at(request, 1), word_at(request, 3));
    case fc::kReadHolding:
    case fc::kReadInput:
      return wrong_length ? malformed(function)
                          : read_registers(bank, function, word_at(request, 1), word_at(request, 3));
    case fc::kWriteCoil:
      return wrong_length ? malformed(function) : write_coil(bank, request);
    case fc::kWriteRegister:
      return wrong_length ? malformed(function) : write_register(bank, request);
    case fc::kWriteCoils:
      return write_coils(bank, request);
    case fc::kWriteRegisters:
      return write_registers(bank, request);
    case fc::kReadWriteRegisters:
      return read_write_registers(bank, request);
    case fc::kDiagnostics:
      return diagnose(request);
    case fc::kEncapsulated:
      return identify(bank, request);
    default:
      return exception_reply(function, ModbusException::kIllegalFunction);
  }
}

RequestSummary summary_of(Pdu request) {
  RequestSummary summary;
  if (request.size() < 5) return summary;
  const RequestSummary::Range range{word_at(request, 1), word_at(request, 3)};
  switch (request[0]) {
    case fc::kReadCoils:
    case fc::kReadDiscreteInputs:
    case fc::kReadHolding:
    case fc::kReadInput:
      summary.read = range;
      break;
    case fc::kWriteCoil:
    case fc::kWriteRegister:
      summary.writes = true;
      summary.written = {range.first, 1};
      break;
    case fc::kWriteCoils:
    case fc::kWriteRegisters:
      summary.writes = true;
      summary.written = range;
      break;
    case fc::kReadWriteRegisters:
      summary.writes = true;
      summary.read = range;
      if (request.size() >= 9) summary.written = {word_at(request, 5), word_at(request, 7)};
      break;
    default:
      break;
  }
  return summary;
}

int rtu_frame_length(std::span<const std::uint8_t> frame) {
  constexpr std::size_t kCountOfWrite = 6;       // after unit, function, address, quantity
  constexpr std::size_t kCountOfReadWrite = 10;  // after two of them
  if (frame.size() < 2) return 0;
  switch (frame[1]) {
    case fc::kReadCoils:
    case fc::kReadDiscreteInputs:
    case fc::kReadHolding:
    case fc::kReadInput:
    case fc::kWriteCoil:
    case fc::kWriteRegister:
    case fc::kDiagnostics:
      return 8;
    case fc::kWriteCoils:
    case fc::kWriteRegisters:
      return frame.size() > kCountOfWrite ? 9 + frame[kCountOfWrite] : 0;
    case fc::kReadWriteRegisters:
      return frame.size() > kCountOfReadWrite ? 13 + frame[kCountOfReadWrite] : 0;
    case fc::kEncapsulated:
      if (frame.size() < 3) return 0;
      return frame[2] == kReadIdentification ? 7 : -1;
    default:
      return -1;
  }
}

std::uint16_t modbus_crc(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0xFFFF;
  for (const auto byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0xA001U : crc >> 1U;
  }
  return static_cast<std::uint16_t>(crc);
}

}  // namespace fvd::sim
