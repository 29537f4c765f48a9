// Whatever a checkpoint holds behind a good check sum, reading it ends with a checkpoint or with an
// Error, and what was read is written and read again as the same bytes.
#include "scratch.hpp"
#include <core/error.hpp>
#include <io/file.hpp>
#include <run/checkpoint.hpp>

#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>

using namespace whirl;

namespace {

/// As the program writes it: head, body, check sum of both (src/run/checkpoint.cpp).
std::string sealed(const std::string& body) {
  constexpr std::uint64_t prime = 1099511628211ull;
  std::string data = "whirl checkpoint 8\n" + body;
  std::uint64_t sum = 14695981039346656037ull;
  std::string_view rest = data;
  for (; rest.size() >= sizeof sum; rest.remove_prefix(sizeof sum)) {
    std::uint64_t word = 0;
    std::memcpy(&word, rest.data(), sizeof word);
    sum = (sum ^ word) * prime;
    sum ^= sum >> 32;
  }
  for (const char c : rest)
    sum = (sum ^ static_cast<unsigned char>(c)) * prime;
  data.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return data;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = fuzz::write("step.whirl", sealed(fuzz::text_of(data, size)));
  std::optional<run::Checkpoint> c;
  try {
    c = run::read_checkpoint(file);
  } catch (const Error&) {
    return 0;
  }
  if (!c) std::abort();
  run::write_checkpoint(file, *c);
  const std::string first = io::read_text(file);
  c = run::read_checkpoint(file);
  run::write_checkpoint(file, *c);
  if (io::read_text(file) != first) std::abort();
  return 0;
}
