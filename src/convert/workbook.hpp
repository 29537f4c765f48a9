// Sheets of workbooks (.xlsx: Office Open XML, ECMA-376) as text.
#pragma once
#include <convert/notes.hpp>
#include <filesystem>
#include <string>

namespace whirl::convert {

/// The cells of a sheet as CSV, commas between them, each row on the line of its number. Formulas
/// give the values they had when the workbook was saved; rows of one cell above the titles are left
/// out. What is not read is noted.
/// sheet: empty for the first that is not hidden and has cells.
/// @throws Error (E42): not a workbook, damaged, no such sheet, larger than a table may be.
std::string sheet_as_csv(const std::filesystem::path& file, const std::string& sheet, Notes& notes);

}  // namespace whirl::convert
