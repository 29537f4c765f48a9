// Names and references: entities, places on shafts, materials, shafts, steps.
#include <deck/text/locate.hpp>
#include <deck/materials.hpp>
#include <deck/reader.hpp>
#include <algorithm>
#include <core/text.hpp>
#include <fmt/format.h>

namespace whirl::deck {

bool Reader::name(model::Entity& entity, const char* kind) {
  note_shape("name", KeyShape::Kind::text);
  const Member* m = find(optional("name", ""));
  Scope* parent = scopes_.size() > 1 ? &scopes_[scopes_.size() - 2] : nullptr;
  auto& names = parent ? parent->names[kind] : scope().names[kind];
  std::string name;
  const bool given = m && read_text("name", m->value, name);
  if (!given) {
    for (std::size_t k = names.size() + 1; name.empty() || names.count(name); ++k)
      name = fmt::format("{} {}", kind, k);
    if (std::string_view(kind) == "shaft" && names.empty()) name = "shaft";
  }
  const Spot spot = m ? m->value.spot : scope().table->spot;
  scope().entity = fmt::format("{} '{}'", kind, name);
  const auto control = [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u < 0x20 || u == 0x7F;
  };
  if (given && !name.empty() && (name.front() == '=' || name.front() == '-' || name.front() == '@'))
    problem("E14", spot, fmt::format("the name \"{}\" begins with '{}'", name, name.front()),
            "names stand in the titles and cells of result tables, where spreadsheets would take "
            "this one for a formula");
  else if (given && !name.empty() && name.front() == '.')
    problem("E14", spot, fmt::format("the name \"{}\" begins with '.'", name),
            "names stand in names of files, which would be hidden ones");
  else if (given && std::any_of(name.begin(), name.end(), control))
    problem("E14", spot, fmt::format("the name \"{}\" has a control character", name),
            "a name is one line of letters, digits and signs");
  else if (given && name.size() > 100)
    problem("E14", spot,
            fmt::format("the name \"{}...\" has {} bytes", name.substr(0, 20), name.size()),
            "names stand in names of files and titles of columns: 100 at most");
  else if (given && (name.empty() || name.find_first_of(":/+\"\\") != std::string::npos))
    problem("E14", spot,
            name.empty()
                ? std::string("the name is empty")
                : fmt::format("the name \"{}\" has a character that places are written with", name),
            "a name may not contain : / + \" or \\");
  const auto [it, fresh] = names.emplace(name, spot);
  if (!fresh)
    problem("E16", spot, fmt::format("{} '{}' exists already", with_article(kind), name),
            fmt::format("the first is in line {}", it->second.line));
  entity.name = name;
  entity.where = where();
  put("name", Value::of_text(name));
  return m != nullptr;
}

bool Reader::location(const Key& k, model::Location& target, const char*) {
  note_shape(k, KeyShape::Kind::text);
  const Member* m = find(k);
  if (!m) return false;
  const Value v = expand(m->value, Parameters::Use::quantity);
  if (!v.is_text()) {
    wrong_type(k.name, v, "a place on a shaft",
               fmt::format("for example {} = \"section:mid\" or \"1.14 m\"", k.name));
    return true;
  }
  // where the shafts themselves are wrong or missing, places on them cannot be judged
  if (model_.shafts.empty()) {
    scope().dirty = true;
    return true;
  }
  // a disk or bearing whose own place was reported, not the one whose place this is
  const auto unplaced = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& x) {
      return &x.at != &target && x.at.text.empty() && v.text.starts_with(x.name);
    });
  };
  const bool shafts_bad = shafts_bad_ || unplaced(model_.disks) || unplaced(model_.bearings);
  const Located found = locate(model_, v.text);
  if (!found.at) {
    if (shafts_bad) {
      if (!withheld_)
        withheld_ = Withheld{found.code, v.spot, fmt::format("'{}': {}", k.name, found.message),
                             found.hint, scope().entity};
      scope().dirty = true;
      return true;
    }
    Spot spot = v.spot;
    if (found.length > 0 && v.text == m->value.text &&
        static_cast<int>(v.text.size()) + 2 == spot.length) {
      spot.column += 1 + static_cast<int>(found.offset);
      spot.length = static_cast<int>(found.length);
    }
    problem(found.code.c_str(), spot, fmt::format("'{}': {}", k.name, found.message), found.hint);
    return true;
  }
  target = *found.at;
  target.where = sources_.where(v.spot);
  put(k, v);
  return true;
}

bool Reader::material(const Key& k, std::size_t& index, const char*) {
  note_shape(k, KeyShape::Kind::text);
  const Member* m = find(k);
  if (!m) return false;
  std::string name;
  if (!read_text(k.name, m->value, name)) return true;
  put(k, Value::of_text(name));
  for (std::size_t i = 0; i < model_.materials.size(); ++i)
    if (model_.materials[i].name == name) {
      index = i;
      return true;
    }
  if (const auto* b = find_builtin_material(name)) {
    index = model_.materials.size();
    model_.materials.push_back(*b);
    return true;
  }
  std::vector<std::string> names;
  for (const auto& x : model_.materials)
    names.push_back(x.name);
  for (const auto& x : builtin_materials())
    names.push_back(x.name);
  const auto near = nearest(name, names);
  problem("E17", m->value.spot, fmt::format("there is no material '{}'", name),
          near.empty() ? "define it with [[material]]"
                       : fmt::format("did you mean '{}'?", near.front()));
  return true;
}

bool Reader::shaft(const Key& k, std::size_t& index, const char*) {
  note_shape(k, KeyShape::Kind::text);
  const Member* m = find(k);
  if (!m) {
    if (model_.shafts.size() > 1)
      problem("E05", scope().table->spot, fmt::format("the key '{}' is missing", k.name),
              "the deck has several shafts: say which");
    return false;
  }
  std::string name;
  if (!read_text(k.name, m->value, name)) return true;
  put(k, Value::of_text(name));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model_.shafts.size(); ++i) {
    if (model_.shafts[i].name == name) {
      index = i;
      return true;
    }
    names.push_back(model_.shafts[i].name);
  }
  const auto near = nearest(name, names);
  problem("E17", m->value.spot, fmt::format("there is no shaft '{}'", name),
          near.empty() ? fmt::format("known: {}", fmt::join(names, ", "))
                       : fmt::format("did you mean '{}'?", near.front()));
  return true;
}

bool Reader::step(const Key& k, std::string& target, const char*) {
  note_shape(k, KeyShape::Kind::text);
  const Member* m = find(k);
  if (!m) return false;
  if (!read_text(k.name, m->value, target)) return true;
  put(k, Value::of_text(target));
  // `from` inside a step: only earlier ones; elsewhere any step. Judged when all steps are known.
  const bool in_step = std::string_view(k.name) == "from";
  pending_steps_.push_back(
      {m->value.spot, target, in_step ? static_cast<int>(model_.steps.size()) - 1 : -1});
  return true;
}

void Reader::settle_steps() {
  std::vector<std::string> names;
  for (const auto& s : model_.steps)
    names.push_back(s.name);
  for (const auto& p : pending_steps_) {
    const auto it = std::find(names.begin(), names.end(), p.name);
    if (it == names.end()) {
      const auto near = nearest(p.name, names);
      problem(p.from >= 0 ? "E30" : "E17", p.spot, fmt::format("there is no step '{}'", p.name),
              near.empty() ? fmt::format("the steps are: {}", fmt::join(names, ", "))
                           : fmt::format("did you mean '{}'?", near.front()));
      continue;
    }
    if (p.from < 0) continue;
    const auto index = static_cast<int>(it - names.begin());
    if (index == p.from)
      problem("E30", p.spot, fmt::format("step '{}' starts from itself", p.name),
              "'from' names an earlier step");
    else if (index > p.from)
      problem("E30", p.spot,
              fmt::format("step '{}' stands below the step that starts from it", p.name),
              "steps run in the order of the deck: move it up");
    else {
      const auto& law = model_.steps[static_cast<std::size_t>(index)].law;
      if (!std::holds_alternative<model::StaticStep>(law) &&
          !std::holds_alternative<model::TransientStep>(law))
        problem("E30", p.spot, fmt::format("step '{}' leaves no state to start from", p.name),
                "'from' names a static or transient step");
    }
  }
}

}  // namespace whirl::deck
