#pragma once

/// The table of a report. Only sources of this folder include it.

#include <span>

#include "daemon/report/canvas.hpp"
#include "daemon/report/value_rows.hpp"

namespace fvd {

[[nodiscard]] double table_height(std::size_t rows);

/// A head line and the rows, as high as table_height() says.
void draw_table(Canvas& canvas, PagePoint top_left, double width, std::span<const ValueRow> rows);

}  // namespace fvd
