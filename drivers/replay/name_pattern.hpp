#pragma once

/// Names of slices as a person describes them: "z_{z_um}um_*.png".

#include <optional>
#include <string>
#include <vector>

#include "drivers/replay/name_order.hpp"

namespace fvd {

/// A pattern of whole file names. {n}: a count, digits. {z_um}, {z_mm}, {z_nm}: z, a decimal number with a sign or
/// without. `*`: any text. All other characters stand for themselves, the extension in either case.
class NamePattern {
 public:
  /// Throws Error kBadInput for a pattern without {n} or z, with a field twice, with an unknown field or a folder.
  explicit NamePattern(std::string text);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool matches(const std::string& name) const;
  /// names: that match. In the order of {n}, else of z upwards; z where the pattern has it. Throws Error kBadInput for
  /// two names with the same number or z.
  [[nodiscard]] NameOrder order(const std::vector<std::string>& names) const;

 private:
  std::string text_;
  std::string expression_;
  std::size_t count_group_ = 0;  ///< 0: the pattern has no {n}
  std::size_t z_group_ = 0;
  double z_unit_um_ = 1.0;
};

}  // namespace fvd
