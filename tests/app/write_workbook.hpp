// Workbooks for tests: parts as text in a zipped file.
#pragma once
#include <minizip/zip.h>
#include <filesystem>
#include <map>
#include <string>

namespace whirl::test {

inline void write_workbook(const std::filesystem::path& file,
                           const std::map<std::string, std::string>& parts) {
  const zipFile zip = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
  for (const auto& [name, text] : parts) {
    constexpr int fast = 1;
    zipOpenNewFileInZip(zip, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                        fast);
    zipWriteInFileInZip(zip, text.data(), static_cast<unsigned>(text.size()));
    zipCloseFileInZip(zip);
  }
  zipClose(zip, nullptr);
}

/// The parts of a workbook of one sheet.
inline std::map<std::string, std::string> workbook_of(const std::string& sheet,
                                                      const std::string& texts) {
  const std::string head = "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n";
  return {{"xl/workbook.xml",
           head + "<workbook xmlns:r=\"r\"><sheets><sheet name=\"Sheet1\" sheetId=\"1\" "
                  "r:id=\"rId1\"/></sheets></workbook>"},
          {"xl/_rels/workbook.xml.rels",
           head + "<Relationships><Relationship Id=\"rId1\" Target=\"worksheets/sheet1.xml\"/>"
                  "</Relationships>"},
          {"xl/worksheets/sheet1.xml",
           head + "<worksheet><sheetData>" + sheet + "</sheetData></worksheet>"},
          {"xl/sharedStrings.xml", head + "<sst>" + texts + "</sst>"}};
}

}  // namespace whirl::test
