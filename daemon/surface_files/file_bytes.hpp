#pragma once

/// The bytes of a file at any place, and what is said where they are wrong.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/unique_fd.hpp"
#include "daemon/surface_files/surface_files.hpp"

namespace fvd {

/// Throws Error kSurfaceFile: "part.sdf: byte 81: the file ends".
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& place, const std::string& reason);

/// "byte 81".
[[nodiscard]] std::string byte_place(std::uint64_t offset);

/// A regular file. All throw Error kSurfaceFile.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path);
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Exactly `bytes` from offset on; an error where the file ends before.
  void read(std::uint64_t offset, void* to, std::size_t bytes) const;
  /// As many bytes from offset on as there are, at most `most`.
  [[nodiscard]] std::string text(std::uint64_t offset, std::size_t most) const;

 private:
  std::filesystem::path path_;
  UniqueFd file_;
  std::uint64_t size_ = 0;
};

/// The bytes of a file one after the other, with little memory.
class ByteStream {
 public:
  explicit ByteStream(const FileBytes& file, std::uint64_t offset = 0) : file_(file), next_(offset) {}
  static constexpr int kEnd = -1;
  /// The next byte, which stays; kEnd behind the last.
  [[nodiscard]] int peek() {
    if (used_ == buffer_.size()) fill();
    return used_ == buffer_.size() ? kEnd : static_cast<unsigned char>(buffer_[used_]);
  }
  void skip() { ++used_; }
  /// Of the byte that peek() gives.
  [[nodiscard]] std::uint64_t offset() const noexcept { return next_ - buffer_.size() + used_; }
  /// The next line without its end, at most `longest` bytes, else an error; nothing behind the last.
  [[nodiscard]] std::optional<std::string> line(std::size_t longest);

 private:
  void fill();

  const FileBytes& file_;
  std::uint64_t next_;  // offset behind the buffer
  std::string buffer_;
  std::size_t used_ = 0;
};

/// The text without blanks at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);
/// The whole text as a number, a "+" in front allowed; nothing where it is none. Finite or not.
[[nodiscard]] std::optional<double> number_of(std::string_view text);
/// The whole text as a decimal integer.
[[nodiscard]] std::optional<std::int64_t> integer_of(std::string_view text);

/// A height of a file as the surface keeps it: NaN for what float32 cannot hold.
[[nodiscard]] float height_of(double metres) noexcept;

struct GridSize {
  int width = 0;
  int height = 0;
  [[nodiscard]] std::uint64_t points() const noexcept {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  }
};
/// Refuses sides below 1 or above 1 000 000, and more than 2^29 points.
[[nodiscard]] GridSize grid_size(const std::filesystem::path& path, const std::string& place, std::int64_t width,
                                 std::int64_t height);

/// The pitch of one axis: the file's, or the caller's where the file tells none. Refuses what is not between 1e-6 um
/// and 1e6 um, two that differ by more than a millionth, and none at all.
[[nodiscard]] double pitch_of(const std::filesystem::path& path, const std::string& place,
                              const std::optional<double>& told_um, const std::optional<double>& given_um);

/// A surface without heights yet: uninitialised, titled by the file's name.
[[nodiscard]] Surface empty_surface(const std::filesystem::path& path, const GridSize& size, double pitch_x_um,
                                    double pitch_y_um);

}  // namespace fvd
