// How the numbers of frames are packed in their files.
#pragma once

namespace whirl {

enum class Compression { none, lz4, zlib };

}  // namespace whirl
