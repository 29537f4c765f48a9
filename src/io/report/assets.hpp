// Style sheet and script of the report, part of the program.
#pragma once

namespace whirl::io {
extern const char report_css[];
extern const char report_js[];
}  // namespace whirl::io
