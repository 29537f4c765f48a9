// Frames written by a thread of their own, while the solver goes on.
#pragma once
#include <io/frames.hpp>
#include <memory>

namespace whirl::io {

/// Hands frames on to `writer`, in their order, on a thread that is started with the first of them.
/// frame() copies the state and returns; it waits where many frames are not yet written, so that
/// memory is bounded. All other calls, and the destructor, wait until everything offered is written:
/// after end() or save() the files are what `writer` alone would have made of them.
///
/// What `writer` throws on its thread, frame() throws at the next frame, or whoever waits first, and
/// so do all calls after it; frames behind the failed one are dropped.
std::unique_ptr<FrameWriter> make_queued_frames(std::unique_ptr<FrameWriter> writer);

}  // namespace whirl::io
