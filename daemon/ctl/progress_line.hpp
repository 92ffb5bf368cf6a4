#pragma once

/// Progress for people: a bar that redraws itself in a terminal, plain lines elsewhere.

#include <ostream>
#include <string>

namespace fvd::ctl {

/// context: one thread at a time.
class ProgressLine {
 public:
  ProgressLine(std::ostream& out, bool terminal) : out_(out), terminal_(terminal) {}
  /// Ends a bar that was not ended, so that what follows starts on its own line.
  ~ProgressLine() { end(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// fraction 0..1, clamped. Draws only if the text changed.
  void update(double fraction, const std::string& text);
  void end();

 private:
  std::ostream& out_;
  bool terminal_;
  bool open_ = false;
  std::string last_;
};

}  // namespace fvd::ctl
