#include <sweep/summary_entries.hpp>
#include <core/types.hpp>
#include <io/file.hpp>
#include <io/json.hpp>

#include <cmath>
#include <cstddef>

namespace whirl::sweep {
namespace {

/// As JSON has them, which has no such numbers.
bool is_not_finite(const std::string& text) {
  return text == "nan" || text == "inf" || text == "-inf";
}

class Flattened {
 public:
  void add(const std::string& path, const io::Value& v) {
    if (v.is_object())
      for (const auto& [key, value] : v.members())
        add(path.empty() ? key : path + "." + key, value);
    else if (v.is_array())
      for (std::size_t k = 0; k < v.items().size(); ++k)
        add(path + "." + std::to_string(k + 1), v.items()[k]);
    else if (v.is_number())
      add_entry(path).number = v.number();
    else if (v.is_text() && is_not_finite(v.text()))
      add_entry(path).number = nan;
    else if (v.is_text() && !v.text().empty())
      add_entry(path).word = v.text();
    else if (const bool* flag = std::get_if<bool>(&v.variant()))
      add_entry(path).word = *flag ? "true" : "false";
  }
  std::vector<SummaryEntry> take() { return std::move(entries_); }

 private:
  SummaryEntry& add_entry(const std::string& path) {
    SummaryEntry e;
    const auto open = path.rfind(" [");
    const bool has_unit = open != std::string::npos && path.back() == ']';
    e.path = path.substr(0, has_unit ? open : path.size());
    if (has_unit) e.unit = path.substr(open + 2, path.size() - open - 3);
    entries_.push_back(std::move(e));
    return entries_.back();
  }

  std::vector<SummaryEntry> entries_;
};

}  // namespace

std::vector<SummaryEntry> read_summary(const std::filesystem::path& file) {
  const std::string text = io::read_text(file);
  Flattened flat;
  flat.add("", io::parse_json(text, file.string()));
  return flat.take();
}

}  // namespace whirl::sweep
