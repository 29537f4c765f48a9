// Is a text well-formed XML? Enough of the grammar for what we write: declaration, elements,
// attributes, text, entities.
#pragma once
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::io {

/// Empty when well-formed, otherwise what is wrong and where.
inline std::string xml_fault(std::string_view s) {
  std::vector<std::string> open;
  std::size_t i = 0;
  bool root = false;
  const auto fault = [&](const std::string& what) {
    return what + " at byte " + std::to_string(i) + ": " +
           std::string(s.substr(i > 40 ? i - 40 : 0, 80));
  };
  const auto name = [&] {
    const std::size_t a = i;
    while (i < s.size() && (std::isalnum(static_cast<unsigned char>(s[i])) || s[i] == '-' ||
                            s[i] == '_' || s[i] == ':' || s[i] == '.'))
      ++i;
    return std::string(s.substr(a, i - a));
  };
  const auto space = [&] {
    while (i < s.size() && std::isspace(static_cast<unsigned char>(s[i])))
      ++i;
  };
  const auto entity = [&] {  // at '&'
    for (const std::string_view e : {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;", "&#9;", "&#10;"})
      if (s.substr(i, e.size()) == e) return true;
    return false;
  };
  if (s.substr(0, 5) == "<?xml") i = s.find("?>") + 2;
  for (space(); i < s.size();) {
    if (s[i] != '<') {
      if (open.empty()) {
        if (!std::isspace(static_cast<unsigned char>(s[i]))) return fault("text outside the root");
      } else if (s[i] == '&' && !entity())
        return fault("bare &");
      ++i;
      continue;
    }
    if (s.substr(i, 2) == "</") {
      i += 2;
      const std::string n = name();
      if (open.empty() || open.back() != n || s[i] != '>')
        return fault("</" + n + "> does not match");
      open.pop_back();
      ++i;
      continue;
    }
    ++i;
    const std::string n = name();
    if (n.empty()) return fault("no element name");
    if (open.empty() && root) return fault("a second root");
    root = true;
    std::vector<std::string> seen;
    for (;;) {
      const std::size_t before = i;
      space();
      if (i >= s.size()) return fault("unfinished tag");
      if (s[i] == '>') {
        open.push_back(n);
        ++i;
        break;
      }
      if (s.substr(i, 2) == "/>") {
        i += 2;
        break;
      }
      if (before == i) return fault("no space before an attribute");
      const std::string a = name();
      for (const auto& o : seen)
        if (o == a) return fault("attribute " + a + " twice");
      seen.push_back(a);
      if (a.empty() || s.substr(i, 2) != "=\"") return fault("attribute of <" + n + ">");
      for (i += 2; i < s.size() && s[i] != '"'; ++i)
        if (s[i] == '<' || (s[i] == '&' && !entity())) return fault("character in attribute " + a);
      ++i;
    }
  }
  if (!open.empty()) return fault("<" + open.back() + "> is not closed");
  return root ? "" : "nothing";
}

}  // namespace whirl::io
