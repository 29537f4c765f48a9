// Which files of a results folder the program made. A folder may hold the user's own files too
// (directory = "."): what no run made is neither removed nor written over, and nothing is written
// through a symbolic link to somewhere else.
#pragma once
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace whirl::io {

/// Threads may use one at the same time.
class Manifest {
 public:
  static constexpr const char* file_name = "manifest.txt";
  /// Reads the list of the folder; an older results folder without one (it has the run.json of this
  /// program) counts as made by the program where files are written, not where they are removed.
  explicit Manifest(std::filesystem::path root);

  /// `name` (relative to the folder, '/' between parts) is going to be written: listed, at once and
  /// for good. A file of that name that no run made is moved aside to "NAME.kept", said on standard
  /// error.
  /// @throws Error (Exit::io, E91) when a folder on the way is a symbolic link, or the name leads
  /// out of the results folder.
  /// @throws Error (E16) when another owner of this run has written it; owner: who writes, empty: nobody
  /// that could meet another.
  void claim(std::string_view name, const std::string& owner = {});
  /// Files that this run reads: none of them is claimed.
  void protect(const std::vector<std::filesystem::path>& inputs);
  /// From now on nothing is listed: of a folder that is thrown away.
  void list_nothing();
  bool lists(std::string_view name) const;
  /// Removes the listed regular files that `which` accepts and this run does not read. Their names stay
  /// listed.
  void remove(const std::function<bool(const std::string& name)>& which) const;
  /// Removes the regular files that this owner has claimed. Their names stay listed.
  void remove_of(const std::string& owner) const;

 private:
  bool inside(const std::string& name) const;
  bool is_read(const std::filesystem::path& file) const;
  void append(const std::string& line);

  std::filesystem::path root_;
  mutable std::mutex mutex_;  ///< of what follows
  std::unordered_set<std::string> names_;
  std::vector<std::filesystem::path> inputs_;           ///< in the folder, without links
  std::unordered_map<std::string, std::string> owner_;  ///< of files written in this run
  bool older_ = false;                                  ///< results of a program that kept no list
  bool listing_ = true;
};

}  // namespace whirl::io
