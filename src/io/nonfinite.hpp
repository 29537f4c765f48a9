// Numbers that are none. A NaN or an infinity in a results file is right only where the file says
// what it means (a mode that is not there at a speed: Table::nan_means). Every other one is counted
// by the writers, and the run says so at its end.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::io {

struct NonFinite {
  std::string file;    ///< name of the file, without folders
  std::string column;  ///< the first one that has some
  std::size_t count = 0;
};

/// Counts `count` more in a file. Any thread may call it.
void note_nonfinite(std::string_view file, std::string_view column, std::size_t count);
/// What was noted since the last call, in the order of the files.
std::vector<NonFinite> take_nonfinite();

}  // namespace whirl::io
