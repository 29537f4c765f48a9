// The state script of ParaView that `whirl view` fills in: paraview_state.py, built into the
// program.
#pragma once

namespace whirl::app {

/// With @script@, @sets@, @shown@, @kinds@ and @folder@ to be replaced.
const char* view_state();

}  // namespace whirl::app
