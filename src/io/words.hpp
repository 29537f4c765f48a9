// Columns of words beside the numbers of an HDF5 file.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::io {

struct WordColumn {
  std::string name, description;
  std::vector<std::string> cells;
};

/// Adds columns of words to a closed HDF5 file, each as a list of strings (UTF-8) below the group
/// "words"; a slash in a name becomes a fraction slash, which parts no groups.
/// @throws Error (Exit::io) when the file cannot be written or the plug-in was not built.
void add_words_hdf5(const std::filesystem::path& file, const std::vector<WordColumn>& columns);

}  // namespace whirl::io
