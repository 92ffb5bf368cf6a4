#pragma once

/// Lengths in files that count in metres, so that the pitch of a surface in um reads back bit for bit.

#include <optional>
#include <string>
#include <string_view>

namespace fvd {

/// The shortest decimal number of metres from which micrometres_of_text() gets `um` again: 480 columns of 1 um are
/// "0.00048". um: of one of `count` points, finite, > 0; the text is the length of all of them.
[[nodiscard]] std::string metres_text(double um, int count = 1);

/// um of one of `count` points that are together as long as the text says in metres; nothing where the text is no
/// number. Finite or not, as the text says.
[[nodiscard]] std::optional<double> micrometres_of_text(std::string_view metres, int count = 1);

/// A number of metres as um: the shortest decimal number that means these metres, with its point moved. A pitch of at
/// most 15 digits comes out as it was typed.
[[nodiscard]] double micrometres_of(double metres);

/// The number of metres from which micrometres_of() gets `um` again, where there is one, else the nearest.
[[nodiscard]] double metres_of(double um);

}  // namespace fvd
