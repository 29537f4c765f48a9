#include <deck/text/parameters.hpp>
#include <core/units.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

constexpr std::size_t longest = 4096;  // bytes a text may grow to

std::string as_text(const Value& v, Parameters::Use use) {
  switch (v.kind) {
    case Value::Kind::boolean: return v.boolean ? "true" : "false";
    case Value::Kind::integer: return fmt::format("{}", v.integer);
    case Value::Kind::real: return units::format_number(v.real);
    default: break;
  }
  if (use == Parameters::Use::text) return v.text;
  const bool plain = v.text.find_first_not_of("0123456789.eE") == std::string::npos;
  return plain ? v.text : "(" + v.text + ")";
}

}  // namespace

Parameters::Parameters(const Value* table, std::map<std::string, std::string> builtin,
                       std::set<std::string> varied)
    : builtin_(std::move(builtin)),
      varied_(std::move(varied)) {
  if (!table) return;
  for (const auto& m : table->members)
    entries_[m.key] = {m.value, m.spot, false, false};
}

Value Parameters::value_of(const std::string& name, const Spot& use_at, Diagnostics& diagnostics) {
  Value bad;
  bad.kind = Value::Kind::unreadable;
  auto it = entries_.find(name);
  if (it == entries_.end()) {
    if (auto b = builtin_.find(name); b != builtin_.end()) return Value::of_text(b->second, use_at);
    std::vector<std::string> names;
    for (const auto& [n, e] : entries_)
      names.push_back(n);
    for (const auto& [n, e] : builtin_)
      names.push_back(n);
    const auto near = nearest(name, names);
    diagnostics.error("E27", use_at, fmt::format("the parameter ${{{}}} is not defined", name),
                      near.empty() ? "define it under [parameters]"
                                   : fmt::format("did you mean ${{{}}}?", near.front()));
    return bad;
  }
  Entry& e = it->second;
  e.used = true;
  if (e.expanding) {
    diagnostics.error("E27", e.spot, fmt::format("the parameter '{}' refers to itself", name),
                      "break the circle of ${...}");
    return bad;
  }
  e.expanding = true;
  Value v = expand(e.value, Use::quantity, diagnostics);
  e.expanding = false;
  const Spot spot = e.value.spot;
  e.value =
      v;  // expanded once: chains cost no more than their length, and a mistake is reported once
  e.value.spot = spot;
  if (varied_.contains(name) || !v.varied.empty()) v.varied = "${" + name + "}";
  return v;
}

Value Parameters::expand(const Value& v, Use use, Diagnostics& diagnostics) {
  if (!v.is_text()) return v;
  std::size_t open = v.text.find("${");
  if (open == std::string::npos) return v;
  Value bad = v;
  bad.kind = Value::Kind::unreadable;
  std::string out, left;
  bool varies = false;
  std::size_t done = 0;
  while (open != std::string::npos) {
    const std::size_t close = v.text.find('}', open);
    if (close == std::string::npos) {
      diagnostics.error("E27", v.spot, fmt::format("\"{}\" has a ${{ that is not closed", v.text),
                        "write ${name}");
      return bad;
    }
    std::string name = v.text.substr(open + 2, close - open - 2);
    const Value p = value_of(name, v.spot, diagnostics);
    if (p.kind == Value::Kind::unreadable) return bad;
    if (open == 0 && close + 1 == v.text.size()) {  // the parameter alone: its value, whatever kind
      Value r = p;
      r.spot = v.spot;
      return r;
    }
    if (p.is_array() || p.is_table() || p.kind == Value::Kind::date) {
      diagnostics.error("E27", v.spot,
                        fmt::format("the parameter ${{{}}} is {} and cannot be part of a text",
                                    name, name_of(p.kind)),
                        "use it alone");
      return bad;
    }
    const std::string before = v.text.substr(done, open - done), inserted = as_text(p, use);
    out += before + inserted;
    left += before + (p.varied.empty() ? inserted : p.varied);
    varies = varies || !p.varied.empty();
    if (out.size() > longest) {
      diagnostics.error("E27", v.spot,
                        fmt::format("\"{}\" grows beyond {} bytes", v.text.substr(0, 40), longest),
                        "");
      return bad;
    }
    done = close + 1;
    open = v.text.find("${", done);
  }
  Value r = v;
  r.text = out + v.text.substr(done);
  if (varies) r.varied = left + v.text.substr(done);
  return r;
}

Value Parameters::varied_table() const {
  Value table = Value::make_table();
  for (const auto& [name, e] : entries_)
    if (e.used && (varied_.contains(name) || !e.value.varied.empty())) table.add(name, e.value);
  return table;
}

void Parameters::warn_unused(Diagnostics& diagnostics) const {
  for (const auto& [name, e] : entries_)
    if (!e.used)
      diagnostics.warning("W01", e.spot, fmt::format("the parameter '{}' is never used", name),
                          fmt::format("use it as \"${{{}}}\" or remove it", name));
}

}  // namespace whirl::deck
