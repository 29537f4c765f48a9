#include <io/nonfinite.hpp>
#include <algorithm>
#include <utility>

namespace whirl::io {

namespace {
std::vector<NonFinite>& noted() {
  static std::vector<NonFinite> list;
  return list;
}
}  // namespace

void note_nonfinite(std::string_view file, std::string_view column, std::size_t count) {
  if (count == 0) return;
  auto& list = noted();
  const auto it = std::find_if(list.begin(), list.end(), [&](const NonFinite& n) { return n.file == file; });
  if (it == list.end()) list.push_back({std::string(file), std::string(column), count});
  else it->count += count;
}

std::vector<NonFinite> take_nonfinite() { return std::exchange(noted(), {}); }

}  // namespace whirl::io
