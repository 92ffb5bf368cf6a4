#include "tests/daemon/api/structured_text.hpp"

#include <algorithm>
#include <cctype>
#include <regex>
#include <stdexcept>
#include <utility>

namespace fvd::test {

namespace {

/// The text of a literal without its quotes.
std::string bytes_of(const std::string& literal) {
  std::string bytes;
  for (std::size_t i = 1; i + 1 < literal.size(); ++i) {
    const bool is_escaped = literal[i] == '$';
    if (is_escaped) ++i;
    bytes += is_escaped && literal[i] == 'L' ? '\n' : literal[i];
  }
  return bytes;
}

std::string without_comments(std::string text) {
  for (std::size_t begin = 0; (begin = text.find("(*", begin)) != std::string::npos;) {
    text.erase(begin, text.find("*)", begin) + 2 - begin);
  }
  return text;
}

std::int64_t number_in(const StValue& value) { return std::get<std::int64_t>(value); }
const std::string& text_in(const StValue& value) { return std::get<std::string>(value); }

}  // namespace

StructuredText::StructuredText(const std::string& source) {
  const std::string text = without_comments(source);
  static const std::regex kToken(R"(T#\w+|'(?:[^'$]|\$.)*'|[A-Za-z_][\w.]*|\d+|:=|<>|<=|>=|\S)");
  for (std::sregex_iterator token(text.begin(), text.end(), kToken), end; token != end; ++token) {
    tokens_.push_back(token->str());
  }
  while (at_ < tokens_.size()) read_unit();
  start_cold();
}

void StructuredText::read_unit() {
  const bool is_function = take() == "FUNCTION";
  Unit unit;
  unit.name = take();
  if (is_function && take_if(":")) unit.declared[unit.name] = {take(), std::int64_t{0}};
  while (peek().starts_with("VAR")) {
    const bool is_input = take() == "VAR_INPUT";
    const bool is_retained = take_if("RETAIN");
    while (!take_if("END_VAR")) declare(unit, is_retained, is_input);
  }
  unit.begin = at_;
  const std::string end = is_function ? "END_FUNCTION" : "END_PROGRAM";
  while (peek() != end) ++at_;
  unit.end = at_++;
  if (is_function) {
    functions_[unit.name] = unit;
  } else {
    program_ = unit;
  }
}

void StructuredText::declare(Unit& unit, bool is_retained, bool is_input) {
  std::vector<std::string> names;
  do names.push_back(take());
  while (take_if(","));
  expect(":");
  Declaration declaration{take(), std::int64_t{0}, 0, is_retained, is_input};
  if (take_if("(")) {
    declaration.longest = std::stoul(take());
    declaration.initial = std::string();
    expect(")");
  }
  if (take_if(":=")) declaration.initial = std::int64_t{std::stoll(take())};
  expect(";");
  for (const std::string& name : names) {
    unit.declared[name] = declaration;
    if (is_input) unit.inputs.push_back(name);
  }
}

void StructuredText::begin_anew(bool keep_retained) {
  for (const auto& [name, declaration] : program_.declared) {
    const bool stays = declaration.is_input || (keep_retained && declaration.is_retained);
    if (!stays || !variables_.contains(name)) variables_[name] = declaration.initial;
  }
}

void StructuredText::start_warm() { begin_anew(true); }
void StructuredText::start_cold() { begin_anew(false); }

std::int64_t StructuredText::number(const std::string& name) const { return number_in(variables_.at(name)); }
std::string StructuredText::text(const std::string& name) const { return text_in(variables_.at(name)); }

void StructuredText::run() { execute(program_); }

void StructuredText::execute(const Unit& unit) {
  const Unit* const outer = std::exchange(running_, &unit);
  const std::size_t back = std::exchange(at_, unit.begin);
  const bool had_returned = std::exchange(has_returned_, false);
  while (at_ < unit.end && !has_returned_) statement(true);
  running_ = outer;
  at_ = back;
  has_returned_ = had_returned;
}

void StructuredText::statements(std::initializer_list<std::string_view> until, bool is_live) {
  while (!is_next(until)) statement(is_live && !has_returned_);
}

void StructuredText::statement(bool is_live) {
  const std::string word = take();
  if (word == "IF") return if_statement(is_live);
  if (word == "CASE") return case_statement(is_live);
  if (word == "WHILE") return while_statement(is_live);
  if (word == "RETURN") {
    expect(";");
    has_returned_ = has_returned_ || is_live;
    return;
  }
  if (take_if("(")) return call_block(word, is_live);
  expect(":=");
  if (is_live) {
    assign(word, expression());
  } else {
    while (peek() != ";") ++at_;
  }
  expect(";");
}

void StructuredText::if_statement(bool is_live) {
  bool was_true = false;
  do {
    const bool holds = number_in(expression()) != 0;
    expect("THEN");
    statements({"ELSIF", "ELSE", "END_IF"}, is_live && holds && !was_true);
    was_true = was_true || holds;
  } while (take_if("ELSIF"));
  if (take_if("ELSE")) statements({"END_IF"}, is_live && !was_true);
  expect("END_IF");
  take_if(";");
}

void StructuredText::case_statement(bool is_live) {
  const std::int64_t wanted = number_in(expression());
  expect("OF");
  while (!take_if("END_CASE")) {
    const bool holds = std::stoll(take()) == wanted;
    expect(":");
    while (peek() != "END_CASE" && std::isdigit(static_cast<unsigned char>(peek()[0])) == 0) {
      statement(is_live && holds && !has_returned_);
    }
  }
  take_if(";");
}

void StructuredText::while_statement(bool is_live) {
  const std::size_t begin = at_;
  for (bool holds = true; holds;) {
    at_ = begin;
    holds = number_in(expression()) != 0 && is_live && !has_returned_;
    expect("DO");
    statements({"END_WHILE"}, holds);
  }
  expect("END_WHILE");
  take_if(";");
}

void StructuredText::call_block(const std::string& name, bool is_live) {
  std::map<std::string, StValue> inputs;
  while (!take_if(")")) {
    const std::string input = take();
    expect(":=");
    inputs[input] = expression();
    take_if(",");
  }
  expect(";");
  if (is_live) blocks_.at(name)(inputs);
}

void StructuredText::assign(const std::string& name, StValue value) {
  const Declaration& declared = running_->declared.at(name);
  if (declared.initial.index() != value.index()) throw std::runtime_error(name + " has another type");
  if (const auto* text = std::get_if<std::string>(&value); text != nullptr && text->size() > declared.longest) {
    throw std::runtime_error(name + " is too short for " + *text);
  }
  variables_[name] = std::move(value);
}

StValue StructuredText::expression() {
  StValue value = conjunction();
  while (take_if("OR")) {
    const StValue right = conjunction();
    value = std::int64_t{number_in(value) != 0 || number_in(right) != 0};
  }
  return value;
}

StValue StructuredText::conjunction() {
  StValue value = comparison();
  while (take_if("AND")) {
    const StValue right = comparison();
    value = std::int64_t{number_in(value) != 0 && number_in(right) != 0};
  }
  return value;
}

StValue StructuredText::comparison() {
  const StValue left = sum();
  if (take_if("=")) return std::int64_t{left == sum()};
  if (take_if("<>")) return std::int64_t{left != sum()};
  if (take_if(">")) return std::int64_t{number_in(left) > number_in(sum())};
  return left;
}

StValue StructuredText::sum() {
  StValue value = product();
  for (;;) {
    if (take_if("+")) {
      value = number_in(value) + number_in(product());
    } else if (take_if("-")) {
      value = number_in(value) - number_in(product());
    } else {
      return value;
    }
  }
}

StValue StructuredText::product() {
  StValue value = operand();
  while (take_if("*")) value = number_in(value) * number_in(operand());
  return value;
}

StValue StructuredText::operand() {
  const std::string token = take();
  if (token == "NOT") return std::int64_t{number_in(operand()) == 0};
  if (token == "TRUE" || token == "FALSE") return std::int64_t{token == "TRUE"};
  if (token == "(") {
    const StValue value = expression();
    expect(")");
    return value;
  }
  if (token[0] == '\'') return bytes_of(token);
  if (token.starts_with("T#")) return token;
  if (std::isdigit(static_cast<unsigned char>(token[0])) != 0) return std::int64_t{std::stoll(token)};
  if (take_if("(")) return call(token);
  const auto found = variables_.find(token);
  if (found == variables_.end()) throw std::runtime_error("no variable " + token);
  return found->second;
}

StValue StructuredText::call(const std::string& name) {
  std::vector<StValue> given;
  while (!take_if(")")) {
    given.push_back(expression());
    take_if(",");
  }
  const auto function = functions_.find(name);
  if (function == functions_.end()) return standard_function(name, given);
  const Unit& unit = function->second;
  std::map<std::string, StValue> inner;
  for (const auto& [local, declared] : unit.declared) inner[local] = declared.initial;
  for (std::size_t i = 0; i < unit.inputs.size(); ++i) inner[unit.inputs[i]] = given.at(i);
  std::swap(variables_, inner);
  execute(unit);
  std::swap(variables_, inner);
  return inner.at(name);
}

StValue StructuredText::standard_function(const std::string& name, const std::vector<StValue>& given) const {
  if (name == "LINT_TO_STRING") return std::to_string(number_in(given.at(0)));
  if (name == "LEN") return static_cast<std::int64_t>(text_in(given.at(0)).size());
  if (name == "CONCAT" && given.size() == 2) return text_in(given[0]) + text_in(given[1]);
  if (name == "FIND") {
    const std::string& text = text_in(given.at(0));
    const std::string& sought = text_in(given.at(1));
    return sought.empty() ? 0 : static_cast<std::int64_t>(text.find(sought) + 1);  // npos + 1 is 0
  }
  if (name == "MID") {  // (text, length, position from 1)
    const std::string& text = text_in(given.at(0));
    const auto begin = static_cast<std::size_t>(number_in(given.at(2)) - 1);
    return begin < text.size() ? text.substr(begin, static_cast<std::size_t>(number_in(given.at(1)))) : std::string();
  }
  throw std::runtime_error("no function " + name + " of so many operands");
}

bool StructuredText::is_next(std::initializer_list<std::string_view> words) const {
  return std::find(words.begin(), words.end(), peek()) != words.end();
}

bool StructuredText::take_if(std::string_view token) {
  if (at_ >= tokens_.size() || peek() != token) return false;
  ++at_;
  return true;
}

void StructuredText::expect(std::string_view token) {
  if (!take_if(token)) throw std::runtime_error("expected " + std::string(token) + ", found " + peek());
}

}  // namespace fvd::test
