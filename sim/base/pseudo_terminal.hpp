#pragma once

/// A pseudo-terminal that stands for a serial line.

#include <filesystem>

#include "sim/base/file_descriptor.hpp"

namespace fvd::sim {

/// Clients may open and close the slave as they like; bytes that none has read wait for the next one. context: the
/// master belongs to one thread.
class PseudoTerminal {
 public:
  /// link: symbolic link to the slave, empty = none; an old link there is replaced, and taken away with the object.
  /// Throws Error kBadConfig if no pseudo-terminal or no link can be had.
  explicit PseudoTerminal(const std::filesystem::path& link);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// The device's end of the line.
  [[nodiscard]] int master() const { return master_.get(); }
  /// What a client opens: the link if there is one, else the slave, /dev/pts/N.
  [[nodiscard]] const std::filesystem::path& path() const { return link_.empty() ? slave_path_ : link_; }
  /// Clients ask for exclusive use of the port; it would outlive them, because the slave is kept open. To be called
  /// after a client was heard.
  void end_exclusive_use() const;

 private:
  FileDescriptor master_;
  std::filesystem::path slave_path_;
  FileDescriptor slave_;  // kept open: the line lives while no client has it
  std::filesystem::path link_;
};

}  // namespace fvd::sim
