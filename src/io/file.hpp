// Files that are either whole or not there.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace whirl::io {

/// Writes `content` beside `file`, waits until it is on the disk and renames it into place. Makes
/// missing folders.
/// @throws Error (Exit::io) when it cannot be written; the old file is then as it was.
void write_atomic(const std::filesystem::path& file, std::string_view content);
/// Whether this process waits until what it writes is on the disk (it does): a process whose results
/// are read back at once and thrown away need not. Not while others write.
void set_waiting_for_disk(bool wait);
/// Name of the file that write_atomic and others use before renaming: same folder, hidden, unique
/// to this process.
std::filesystem::path temporary_beside(const std::filesystem::path& file);
/// Removes from `folder` and the folders in it what a killed process left before renaming; files of
/// other processes that live stay. Call it before this process writes there: a name with its own
/// number is taken for a dead predecessor's.
void remove_leftovers(const std::filesystem::path& folder);
/// Renames; removes `from` and throws on failure.
/// @throws Error (Exit::io) when it cannot be written.
void rename_into_place(const std::filesystem::path& from, const std::filesystem::path& to);
/// @throws Error (Exit::io) when it cannot be read.
std::string read_text(const std::filesystem::path& file);
[[noreturn]] void io_failure(const std::filesystem::path& file, const std::string& what,
                             int error_number = 0);

/// An append-only file descriptor with a fixed buffer; short writes and full disks become Errors.
class AppendFile {
 public:
  explicit AppendFile(std::size_t buffer_bytes);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;
  /// A new file holding `head`, put in place of an older one in one go.
  /// @throws Error (Exit::io) when it cannot be written (also all that follow but the destructor).
  void create(const std::filesystem::path& file, std::string_view head);
  /// An existing file cut to `size` bytes; appends go there.
  void reopen(const std::filesystem::path& file, std::uint64_t size);
  bool is_open() const { return fd_ >= 0; }
  /// Space for at least n more bytes (n <= buffer size), to be filled and then committed.
  char* reserve(std::size_t n);
  void commit(std::size_t n) { used_ += n; }
  void flush();
  /// As flush(), and safe from a power cut: before something else counts on it.
  void sync();
  void close();

 private:
  std::filesystem::path path_;
  std::string buffer_;
  std::size_t used_ = 0;
  int fd_ = -1;
};

/// An existing file parts of which are replaced, each in one write.
class OverwriteFile {
 public:
  OverwriteFile() = default;
  OverwriteFile(OverwriteFile&& o) noexcept
      : path_(std::move(o.path_)),
        fd_(std::exchange(o.fd_, -1)) {}
  OverwriteFile& operator=(OverwriteFile&&) = delete;
  ~OverwriteFile() { close(); }
  void open(const std::filesystem::path& file);
  void put(std::uint64_t offset, std::string_view content);

 private:
  void close();
  std::filesystem::path path_;
  int fd_ = -1;
};

}  // namespace whirl::io
