/// An image file of a slice; its first bytes say which reader it is for.

#include "drivers/replay/image_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

namespace {

void read(const std::filesystem::path& file, std::string_view text, ImageFile& image) {
  if (text.starts_with("P")) return read_pgm(file, image);
  if (text.starts_with("BM")) return read_bmp(file, image);
  if (text.starts_with("\x89")) return read_png(file, image);
  if (text.starts_with("\xFF")) return read_jpeg(file, image);
  if (text.starts_with("C")) return read_contiguous_tiff(file, 1, image);
  return read_tiff(file, 0, image);
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  using namespace fvd::test;
  // A C before a TIFF has it read as the second image behind one directory.
  const std::string_view text = text_of({bytes, size});
  const std::size_t mark = text.starts_with("C") ? 1 : 0;
  const InputFile file({bytes + mark, size - mark});
  ImageFile image;
  try {
    read(file.path(), text, image);
    require(image.width > 0 && image.height > 0 && (image.channels == 1 || image.channels == 3));
    require(image.samples.size() == image.row_bytes() * static_cast<std::size_t>(image.height));
  } catch (const ImageFileError& error) {
    require(*error.what() != '\0');
  }
  return 0;
}
