#pragma once

/// Runs a program in structured text (IEC 61131-3), as far as line_loop.st uses the language: one call is one cycle.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace fvd::test {

/// Of a variable: BOOL and whole numbers, or STRING.
using StValue = std::variant<std::int64_t, std::string>;

/// Throws std::runtime_error for text that it does not understand, an unknown name, and a string that is cut: a
/// controller would cut it without a word.
class StructuredText {
 public:
  /// A call of a function block, with its inputs; its outputs are set in the program's variables.
  using Block = std::function<void(const std::map<std::string, StValue>& inputs)>;

  /// source: the PROGRAM and the FUNCTIONs that it needs.
  explicit StructuredText(const std::string& source);

  /// Of a variable whose type is a function block.
  void on_block(const std::string& name, Block block) { blocks_[name] = std::move(block); }
  /// Declares an output of a function block too: "ask.done".
  void set(const std::string& name, StValue value) { variables_[name] = std::move(value); }
  [[nodiscard]] std::int64_t number(const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& name) const;

  /// One cycle.
  void run();
  /// The power was lost: what is not RETAIN begins as declared; inputs stay as they are.
  void start_warm();
  /// A download: everything begins as declared, inputs stay as they are.
  void start_cold();

 private:
  struct Declaration {
    std::string type;
    StValue initial;
    std::size_t longest = 0;  // of a STRING
    bool is_retained = false;
    bool is_input = false;
  };
  struct Unit {
    std::string name;
    std::vector<std::string> inputs;
    std::map<std::string, Declaration> declared;
    std::size_t begin = 0;  // of its statements
    std::size_t end = 0;
  };

  void read_unit();
  void declare(Unit& unit, bool is_retained, bool is_input);
  void begin_anew(bool keep_retained);

  void execute(const Unit& unit);
  /// Statements up to one of the words; executes them where is_live.
  void statements(std::initializer_list<std::string_view> until, bool is_live);
  void statement(bool is_live);
  void if_statement(bool is_live);
  void case_statement(bool is_live);
  void while_statement(bool is_live);
  void call_block(const std::string& name, bool is_live);
  void assign(const std::string& name, StValue value);

  StValue expression();
  StValue conjunction();
  StValue comparison();
  StValue sum();
  StValue product();
  StValue operand();
  StValue call(const std::string& name);
  [[nodiscard]] StValue standard_function(const std::string& name, const std::vector<StValue>& given) const;

  [[nodiscard]] const std::string& peek() const { return tokens_.at(at_); }
  [[nodiscard]] bool is_next(std::initializer_list<std::string_view> words) const;
  std::string take() { return tokens_.at(at_++); }
  bool take_if(std::string_view token);
  void expect(std::string_view token);

  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
  bool has_returned_ = false;
  std::map<std::string, Unit> functions_;
  Unit program_;
  const Unit* running_ = nullptr;
  std::map<std::string, StValue> variables_;
  std::map<std::string, Block> blocks_;
};

}  // namespace fvd::test
