#include "frame_template.hpp"

#include <vtkDataCompressor.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>

namespace whirl::io {

namespace {

constexpr std::string_view data_mark = "<AppendedData", data_end = "\n  </AppendedData>";

std::string opening_of(std::string_view name) {
  std::string opening(1, ' ');
  opening.append(name).append("=\"");
  return opening;
}

/// Value of an attribute within a tag; empty: it has none of this name.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string opening = opening_of(name);
  const std::size_t at = tag.find(opening);
  if (at == std::string_view::npos) return {};
  const std::size_t first = at + opening.size();
  return tag.substr(first, tag.find('"', first) - first);
}

/// Place of the data in the file: behind the first '_' after the mark.
std::size_t data_begins(std::string_view file) {
  const std::size_t mark = file.find(data_mark);
  if (mark == std::string_view::npos) return mark;
  const std::size_t tag_ends = file.find('>', mark);
  const std::size_t line = file.find('_', tag_ends);
  return line == std::string_view::npos ? line : line + 1;
}

void put_word(std::string& to, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  char bytes[sizeof word];
  std::memcpy(bytes, &word, sizeof word);
  to.append(bytes, sizeof word);
}

/// Least and largest value; of several components, of their Euclidean norms.
template <class T>
std::pair<double, double> range_of(const T* values, std::size_t n, int components) {
  const auto step = static_cast<std::size_t>(components);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i + step <= n; i += step) {
    double x = static_cast<double>(values[i]);
    if (components > 1) {
      x *= x;
      for (std::size_t k = 1; k < step; ++k)
        x += static_cast<double>(values[i + k]) * static_cast<double>(values[i + k]);
    }
    if (!std::isfinite(x)) return {NAN, NAN};
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return components > 1 ? std::pair(std::sqrt(low), std::sqrt(high)) : std::pair(low, high);
}

}  // namespace

FrameTemplate::FrameTemplate(const std::string& file, const PolyData& data,
                             vtkDataCompressor* compressor, std::size_t block_size)
    : compressor_(compressor),
      block_size_(block_size) {
  read(file, data);
}

void FrameTemplate::read(const std::string& file, const PolyData& data) {
  const std::size_t begins = data_begins(file), ends = file.rfind(data_end);
  if (begins == std::string::npos || ends == std::string::npos || ends < begins) return;
  head_ = file.substr(0, begins);
  tail_ = file.substr(ends);
  std::string section;
  std::vector<std::size_t> offsets;
  for (std::size_t tag = head_.find('<'); tag != std::string::npos;
       tag = head_.find('<', tag + 1)) {
    const std::size_t tag_ends = head_.find('>', tag);
    if (tag_ends == std::string::npos) return;
    const std::string_view text = std::string_view(head_).substr(tag, tag_ends - tag);
    if (text.starts_with("<DataArray ") || text.starts_with("<Array ")) {
      names_.push_back(section + "/" + std::string(attribute(text, "Name")));
      offsets.push_back(read_block(tag, tag_ends));
    } else if (!text.starts_with("</")) {
      section = text.substr(1, text.find_first_of(" >") - 1);
    }
  }
  offsets.push_back(ends - begins);
  if (blocks_.empty() || !std::is_sorted(offsets.begin(), offsets.end())) return;
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    blocks_[k].encoded = file.substr(begins + offsets[k], offsets[k + 1] - offsets[k]);
  const auto number_of = [&](std::string_view name) {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  };
  time_ = number_of("FieldData/TimeValue");
  places_ = number_of("Points/Points");
  place_values_ = data.points.size();
  understood_ = time_ < blocks_.size() && places_ < blocks_.size() &&
                find_slots(data.point_data, "PointData", point_data_) &&
                find_slots(data.cell_data, "CellData", cell_data_);
}

/// Its attributes; returns where its data begin.
std::size_t FrameTemplate::read_block(std::size_t tag, std::size_t tag_ends) {
  const std::string_view text = std::string_view(head_).substr(tag, tag_ends - tag);
  const auto field = [&](std::string_view name) {
    const std::size_t from = text.find(opening_of(name));
    if (from == std::string_view::npos) return Field{};
    const std::size_t quoted = text.find('"', text.find('"', from) + 1) + 1;
    const std::size_t to = std::min(text.find_first_not_of(' ', quoted), text.size());
    const bool more = to < text.size() && text[to] != '/';
    return Field{tag + from, (more ? to - 1 : to) - from};
  };
  blocks_.push_back({field("RangeMin"), field("RangeMax"), field("offset"), {}, {}});
  const std::string_view offset = attribute(text, "offset");
  std::size_t value = SIZE_MAX;
  std::from_chars(offset.data(), offset.data() + offset.size(), value);
  return value;
}

bool FrameTemplate::find_slots(const std::vector<PolyData::Array>& arrays, std::string_view section,
                               std::vector<Slot>& slots) const {
  for (const PolyData::Array& a : arrays) {
    const auto block = std::find(names_.begin(), names_.end(), std::string(section) + "/" + a.name);
    if (block == names_.end()) return false;
    const std::size_t n = std::visit([](const auto& v) { return v.size(); }, a.values);
    slots.push_back({a.name, static_cast<std::size_t>(block - names_.begin()), n, a.components});
  }
  return true;
}

bool FrameTemplate::fit(const std::vector<PolyData::Array>& arrays,
                        const std::vector<Slot>& slots) {
  return std::equal(arrays.begin(), arrays.end(), slots.begin(), slots.end(),
                    [](const PolyData::Array& a, const Slot& s) {
                      const std::size_t n =
                          std::visit([](const auto& v) { return v.size(); }, a.values);
                      return a.name == s.name && a.components == s.components && n == s.values;
                    });
}

bool FrameTemplate::fits(const PolyData& data) const {
  return understood_ && data.points.size() == place_values_ && fit(data.point_data, point_data_) &&
         fit(data.cell_data, cell_data_);
}

const std::string* FrameTemplate::fill(const PolyData& data, double time) {
  bool finite = renew(blocks_[time_], &time, 1, 1) &&
                renew(blocks_[places_], data.points.data(), data.points.size(), 3);
  for (std::size_t k = 0; finite && k < point_data_.size(); ++k)
    finite = renew(blocks_[point_data_[k].block], data.point_data[k]);
  for (std::size_t k = 0; finite && k < cell_data_.size(); ++k)
    finite = renew(blocks_[cell_data_[k].block], data.cell_data[k]);
  if (!finite) return nullptr;
  std::size_t offset = 0;
  for (const Block& b : blocks_) {
    char text[40];
    const int n = std::snprintf(text, sizeof text, " offset=\"%zu\"", offset);
    write(b.offset, std::string_view(text, static_cast<std::size_t>(n)));
    offset += b.encoded.size();
  }
  file_.assign(head_);
  for (const Block& b : blocks_)
    file_.append(b.encoded);
  file_.append(tail_);
  return &file_;
}

bool FrameTemplate::renew(Block& block, const PolyData::Array& array) {
  return std::visit(
      [&](const auto& values) {
        return renew(block, values.data(), values.size(), array.components);
      },
      array.values);
}

/// False: a number is not finite, and the block is as it was.
template <class T>
bool FrameTemplate::renew(Block& block, const T* values, std::size_t n, int components) {
  const std::string_view bytes(reinterpret_cast<const char*>(values), n * sizeof(T));
  if (n == 0 || block.raw == bytes) return true;
  const auto [low, high] = range_of(values, n, components);
  if (!std::isfinite(low) || !std::isfinite(high)) return false;
  block.raw.assign(bytes);
  char text[60];
  int length = std::snprintf(text, sizeof text, " RangeMin=\"%.11g\"", low);
  write(block.low, std::string_view(text, static_cast<std::size_t>(length)));
  length = std::snprintf(text, sizeof text, " RangeMax=\"%.11g\"", high);
  write(block.high, std::string_view(text, static_cast<std::size_t>(length)));
  encode(block);
  return true;
}

// Compressed: the number of pieces, the size of one and of an incomplete last one, the sizes of all as
// compressed, the pieces. Else: the size, the bytes. All sizes as 32 bits.
void FrameTemplate::encode(Block& block) {
  const std::string& raw = block.raw;
  block.encoded.clear();
  if (compressor_ == nullptr) {
    put_word(block.encoded, raw.size());
    block.encoded.append(raw);
    return;
  }
  const std::size_t last = raw.size() % block_size_;
  const std::size_t pieces = raw.size() / block_size_ + (last > 0 ? 1 : 0);
  put_word(block.encoded, pieces);
  put_word(block.encoded, block_size_);
  put_word(block.encoded, last);
  const std::size_t sizes = block.encoded.size();
  block.encoded.append(pieces * sizeof(std::uint32_t), '\0');
  packed_.resize(compressor_->GetMaximumCompressionSpace(block_size_));
  for (std::size_t k = 0; k < pieces; ++k) {
    const std::size_t from = k * block_size_, size = std::min(block_size_, raw.size() - from);
    const std::size_t packed =
        compressor_->Compress(reinterpret_cast<const unsigned char*>(raw.data()) + from, size,
                              packed_.data(), packed_.size());
    const auto word = static_cast<std::uint32_t>(packed);
    std::memcpy(block.encoded.data() + sizes + k * sizeof word, &word, sizeof word);
    block.encoded.append(reinterpret_cast<const char*>(packed_.data()), packed);
  }
}

/// White space where the attribute is shorter than its field.
void FrameTemplate::write(const Field& field, std::string_view attribute) {
  if (field.width == 0) return;
  head_.replace(field.place, field.width, field.width, ' ');
  head_.replace(field.place, std::min(attribute.size(), field.width), attribute, 0, field.width);
}

}  // namespace whirl::io
