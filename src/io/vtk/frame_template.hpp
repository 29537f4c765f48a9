// The file of a frame made from the one that VTK wrote of an earlier frame: of the same arrays only the
// numbers differ. Byte for byte what VTK would write, in a third of the time.
#pragma once
#include <io/polydata.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

class vtkDataCompressor;

namespace whirl::io {

class FrameTemplate {
 public:
  /// file: of `data`, appended and raw. compressor: that of the writer, null: none; it must live as long.
  /// block_size: bytes that are compressed together.
  FrameTemplate(const std::string& file, const PolyData& data, vtkDataCompressor* compressor,
                std::size_t block_size);

  /// Whether the file was understood, and the arrays are those of its frame. Cells and names are the
  /// caller's to compare (PolyData::topology).
  bool fits(const PolyData& data) const;

  /// The file of a frame, good until the next call; null where a number is not finite: VTK has words of
  /// its own for such a range.
  /// @pre fits(data).
  const std::string* fill(const PolyData& data, double time);

 private:
  /// Where the head has an attribute, white space up to the next one included.
  struct Field {
    std::size_t place = 0, width = 0;
  };
  /// An array: its attributes in the head, and what stands of it behind the head.
  struct Block {
    Field low, high, offset;
    std::string encoded;
    std::string raw;  ///< the numbers that were encoded
  };
  /// Of an array of PolyData: its block, and what it must look like.
  struct Slot {
    std::string name;
    std::size_t block = 0, values = 0;
    int components = 1;
  };

  void read(const std::string& file, const PolyData& data);
  std::size_t read_block(std::size_t tag, std::size_t tag_ends);
  bool find_slots(const std::vector<PolyData::Array>& arrays, std::string_view section,
                  std::vector<Slot>& slots) const;
  static bool fit(const std::vector<PolyData::Array>& arrays, const std::vector<Slot>& slots);
  bool renew(Block& block, const PolyData::Array& array);
  template <class T>
  bool renew(Block& block, const T* values, std::size_t n, int components);
  void encode(Block& block);
  void write(const Field& field, std::string_view attribute);

  std::string head_, tail_, file_;
  std::vector<Block> blocks_;       ///< in the order of the file
  std::vector<std::string> names_;  ///< of the blocks: "section/name"
  std::vector<Slot> point_data_, cell_data_;
  std::size_t time_ = 0, places_ = 0, place_values_ = 0;
  vtkDataCompressor* compressor_;
  std::size_t block_size_;
  std::vector<unsigned char> packed_;
  bool understood_ = false;
};

}  // namespace whirl::io
