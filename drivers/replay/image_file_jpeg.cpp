#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include <turbojpeg.h>

#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

struct Closer {
  void operator()(void* decoder) const noexcept { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Closer>;

/// A warning counts: libjpeg has filled what was missing with grey then.
void check(const Decoder& decoder, int result) {
  if (result != 0) throw ImageFileError(std::string("libjpeg: ") + tjGetErrorStr2(decoder.get()));
}

}  // namespace

void read_jpeg(const std::filesystem::path& file, ImageFile& image) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ImageFileError("it cannot be opened");
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const Decoder decoder(tjInitDecompress());
  if (!decoder) throw std::bad_alloc();
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colours = 0;
  check(decoder, tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &subsampling, &colours));
  const bool grey = colours == TJCS_GRAY;
  image.resize(width, height, grey ? 1 : 3, 1);
  check(decoder,
        tjDecompress2(decoder.get(), data, bytes.size(), reinterpret_cast<unsigned char*>(image.samples.data()), width,
                      0, height, grey ? TJPF_GRAY : TJPF_BGR, TJFLAG_ACCURATEDCT));
}

}  // namespace fvd
