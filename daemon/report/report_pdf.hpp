#pragma once

/// The report of a result for people, as a PDF file.

#include <string>

#include "daemon/report/picture_surface.hpp"
#include "daemon/result/result.hpp"

namespace fvd {

/// Values on the first page; more go on further pages.
inline constexpr int kValuesOnFirstPage = 14;

/// A page of A4: head, height map, shaded view, up to three profiles, table of values, conditions, foot. surface: as
/// measured. Text is text, not outlines. The same result and surface give the same bytes. Throws Error kInternal.
/// context: thread-safe. About 0.1 s.
[[nodiscard]] std::string report_pdf(const Result& result, const PictureSurface& surface);

}  // namespace fvd
