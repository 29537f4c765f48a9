#include <io/nonfinite.hpp>
#include <algorithm>
#include <mutex>
#include <utility>

namespace whirl::io {

namespace {
std::mutex noting;

std::vector<NonFinite>& noted() {
  static std::vector<NonFinite> list;
  return list;
}
}  // namespace

void note_nonfinite(std::string_view file, std::string_view column, std::size_t count) {
  if (count == 0) return;
  const std::lock_guard lock(noting);
  auto& list = noted();
  const auto it =
      std::find_if(list.begin(), list.end(), [&](const NonFinite& n) { return n.file == file; });
  if (it == list.end())
    list.push_back({std::string(file), std::string(column), count});
  else
    it->count += count;
}

std::vector<NonFinite> take_nonfinite() {
  const std::lock_guard lock(noting);
  return std::exchange(noted(), {});
}

}  // namespace whirl::io
