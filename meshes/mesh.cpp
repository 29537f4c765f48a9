#include <meshes/mesh.hpp>
#include <core/contract.hpp>
#include <core/interrupt.hpp>
#include <model/resolution.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::meshes {
namespace {

using model::Location;
using model::Model;
using model::Section;
using model::Shaft;

/// Places closer than this part of the line's length are one place: round-off of sums of section
/// lengths.
constexpr double same_place = 1e-9;

/// More elements than this in one section are a mistake in units, not a mesh.
constexpr double most_elements = 1e6;

struct Attached {
  const Location* where;
  std::string label;
  double weight = 0;  ///< kg, of a disk
  int holds = 0;      ///< a rigid support, the more the more motions along lines it holds: it
                      ///< decides where the node of a rigid stretch stands
};

std::string named(const char* kind, const model::Entity& e) {
  return e.name.empty() ? std::string(kind) : fmt::format("{} '{}'", kind, e.name);
}

/// Of two that hold as much the one that holds x goes before: off the node x is held by what holds
/// the tilts.
int holds_of(const model::Bearing& x) {
  const model::SupportTraits traits = model::traits_of(x.law);
  if (traits.acts != model::Acts::as_constraint || x.to || x.pedestal) return 0;
  const model::Directions& held = *traits.held;
  return 1 + 2 * (int{held[0]} + int{held[1]} + int{held[2]}) + int{held[0]};
}

std::vector<Attached> attachments(const Model& m) {
  std::vector<Attached> out;
  for (const auto& x : m.disks)
    out.push_back({&x.at, named("disk", x), x.mass});
  for (const auto& x : m.unbalances) {
    out.push_back({&x.at, named("unbalance", x)});
    if (x.to) out.push_back({&*x.to, named("unbalance", x)});
  }
  for (const auto& x : m.cracks) {
    out.push_back({&x.at, named("crack", x)});
    if (x.to) out.push_back({&*x.to, named("crack", x)});
  }
  for (const auto& x : m.bearings) {
    out.push_back({&x.at, named("bearing", x), 0.0, holds_of(x)});
    if (x.to) out.push_back({&*x.to, named("bearing", x)});
    if (const model::Location* sensor = model::traits_of(x.law).sensor)
      out.push_back({sensor, named("sensor of bearing", x)});
  }
  for (const auto& x : m.joints) {
    out.push_back({&x.at, named("joint", x)});
    if (x.to) out.push_back({&*x.to, named("joint", x)});
  }
  for (const auto& x : m.loads)
    out.push_back({&x.at, named("load", x)});
  for (const auto& x : m.drives)
    out.push_back({&x.at, named("drive", x)});
  for (const auto& x : m.probes)
    out.push_back({&x.at, named("probe", x)});
  for (const auto& s : m.steps) {
    if (const auto* h = std::get_if<model::HarmonicStep>(&s.law))
      for (const auto& x : h->forces)
        out.push_back({&x.at, fmt::format("force of step '{}'", s.name)});
    if (const auto* p = std::get_if<model::StaticStep>(&s.law);
        p && p->path && p->path->control == model::LoadPath::Control::displacement)
      out.push_back({&p->path->at, fmt::format("control of step '{}'", s.name)});
  }
  return out;
}

class Checker {
 public:
  void add(const char* code, std::string message, std::string hint, const Where& where,
           std::string entity) {
    Diagnostic d{Diagnostic::Severity::error, code, std::move(message), std::move(hint), where};
    if (d.where.entity.empty()) d.where.entity = std::move(entity);
    found_.push_back(std::move(d));
  }
  void finish() {
    if (found_.empty()) return;
    std::stable_sort(found_.begin(), found_.end(),
                     [](const auto& a, const auto& b) { return a.where.line < b.where.line; });
    throw Error(Exit::deck, std::move(found_));
  }

 private:
  std::vector<Diagnostic> found_;
};

void check_section(const Shaft& shaft, const Section& s, double model_largest, Checker& check) {
  const double largest = std::min(s.max_element_length, model_largest);
  const std::string who = fmt::format("section '{}' of shaft '{}'", s.name, shaft.name);
  if (!(s.length > 0))
    check.add("E14", fmt::format("{}: the length {} m is not positive", who, s.length), {}, s.where,
              who);
  if (!s.rigid && largest > 0 && s.length / largest > most_elements)
    check.add("E14",
              fmt::format("{}: elements of {} m would be {:.3g} of them", who, largest,
                          s.length / largest),
              "more than a million elements in one section", s.where, who);
  if (s.min_elements < 0 || !(s.max_element_length > 0))
    check.add("E14", fmt::format("{}: at least one element of positive length is needed", who), {},
              s.where, who);
  const bool wants_circle = !s.rigid && !s.constants && !s.general;
  const auto circle = [&](double od, double id, const char* which) {
    if (wants_circle && !(od > 0))
      check.add("E14", fmt::format("{}: the {}outer diameter {} m is not positive", who, which, od),
                {}, s.where, who);
    else if (od < 0 || id < 0 || (od > 0 && id >= od))
      check.add("E23",
                fmt::format("{}: the {}bore, {} m, is not smaller than the outer diameter, {} m",
                            who, which, id, od),
                "diameters are meant, not radii", s.where, who);
  };
  circle(s.od_l, s.id_l, "");
  if (s.od_r != s.od_l || s.id_r != s.id_l) circle(s.od_r, s.id_r, "right ");
  if (s.stiffness_diameters && wants_circle) {
    const auto& d = *s.stiffness_diameters;
    circle(d[0], d[1], "stiffness ");
    if (d[2] != d[0] || d[3] != d[1]) circle(d[2], d[3], "right stiffness ");
  }
  if (s.constants && !s.rigid && !(s.constants->EI > 0 && std::isfinite(s.constants->EI)))
    check.add(
        "E14",
        fmt::format("{}: EI must be positive and finite; use a rigid section for a rigid one", who),
        {}, s.where, who);
}

void check_model(const Model& m, const std::vector<Attached>& attached) {
  Checker check;
  if (m.shafts.empty()) {
    Where deck;
    deck.file = m.deck_path;
    check.add("E35", "the model has no shaft", "add a [shaft] with its sections", deck, "model");
  }
  for (const Shaft& shaft : m.shafts)
    for (const Section& s : shaft.sections)
      check_section(shaft, s, m.max_element_length, check);
  for (const Attached& a : attached) {
    if (a.where->shaft >= m.shafts.size()) {
      check.add("E17", fmt::format("{} stands on a shaft that does not exist", a.label), {},
                a.where->where, a.label);
      continue;
    }
    const Shaft& shaft = m.shafts[a.where->shaft];
    const double L = shaft.length(), s = a.where->s;
    if (!(s >= -same_place * L && s <= L * (1 + same_place)))
      check.add("E19",
                fmt::format("{} stands at {:.6g} m, but shaft '{}' reaches from 0 to {:.6g} m",
                            a.label, s, shaft.name, L),
                {}, a.where->where, a.label);
  }
  check.finish();
}

/// Numbers of equal elements in the pieces of a section between its attachments.
std::vector<int> element_counts(const std::vector<double>& cuts, double largest, int least) {
  WHIRL_EXPECTS(cuts.size() > 1 && largest > 0.0 && least > 0);
  WHIRL_EXPECTS(std::is_sorted(cuts.begin(), cuts.end()));
  std::vector<int> n;
  int total = 0;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    const double pieces = (cuts[k + 1] - cuts[k]) / largest;
    n.push_back(std::max(1, static_cast<int>(std::ceil(pieces * (1 - 1e-12)))));
    total += n.back();
  }
  for (; total < least; ++total) {  // one more where the elements are longest
    std::size_t worst = 0;
    for (std::size_t k = 1; k < n.size(); ++k)
      if ((cuts[k + 1] - cuts[k]) / n[k] > (1 + 1e-9) * (cuts[worst + 1] - cuts[worst]) / n[worst])
        worst = k;
    ++n[worst];
  }
  return n;
}

/// One shaft line: walks its sections from left to right.
class LineMesher {
 public:
  LineMesher(const Model& m, std::size_t index, const std::vector<Attached>& attached,
             const model::Resolution& resolution, Mesh& mesh)
      : model_(m),
        resolution_(resolution),
        shaft_(m.shafts[index]),
        mesh_(mesh),
        index_(static_cast<Index>(index)) {
    line_.name = shaft_.name;
    line_.origin = shaft_.origin;
    line_.rotating = shaft_.rotating;
    line_.first_node = static_cast<Index>(mesh.nodes.size());
    line_.first_element = static_cast<Index>(mesh.elements.size());
    line_.first_station = static_cast<Index>(mesh.stations.size());
    ends_.push_back(0.0);
    for (const Section& s : shaft_.sections)
      ends_.push_back(ends_.back() + s.length);
    line_.length = ends_.back();
    tolerance_ = same_place * line_.length;
    for (const Attached& a : attached)
      if (a.where->shaft == index) attached_.push_back(&a);
    std::stable_sort(attached_.begin(), attached_.end(),
                     [](auto* a, auto* b) { return a->where->s < b->where->s; });
  }

  void run() {
    if (shaft_.sections.empty()) end_ = {add_node(0.0), 0.0};
    for (std::size_t k = 0; k < shaft_.sections.size();)
      k = shaft_.sections[k].rigid ? rigid_stretch(k) : flexible(k);
    line_.nodes = static_cast<Index>(mesh_.nodes.size()) - line_.first_node;
    line_.elements = static_cast<Index>(mesh_.elements.size()) - line_.first_element;
    add_stations();
    mesh_.lines.push_back(line_);
  }

 private:
  Index add_node(double s) {
    Node n;
    n.position = shaft_.position(s);
    n.line = index_;
    n.s = s;
    n.name = fmt::format("node at {:.6g} m of {} '{}'", s, shaft_.rotating ? "shaft" : "casing",
                         shaft_.name);
    mesh_.nodes.push_back(std::move(n));
    return static_cast<Index>(mesh_.nodes.size()) - 1;
  }

  /// Sections k.. that are rigid: one node, at the rigid support that holds most if there is one,
  /// else at the heaviest body, else in the middle.
  std::size_t rigid_stretch(std::size_t first) {
    std::size_t last = first;
    while (last < shaft_.sections.size() && shaft_.sections[last].rigid)
      ++last;
    const double a = ends_[first], b = ends_[last];
    double where = 0.5 * (a + b), heaviest = 0;
    int holds = 0;
    for (const Attached* x : attached_) {
      if (x->where->s < a - tolerance_ || x->where->s > b + tolerance_) continue;
      const double s = std::clamp(x->where->s, a, b);
      if (x->holds > holds) {
        where = s;
        holds = x->holds;
      }
      if (holds == 0 && x->weight > heaviest) {
        where = s;
        heaviest = x->weight;
      }
    }
    const Index node = add_node(where);
    if (pending_ >= 0) {
      mesh_.elements[at(pending_)].right = {node, a - where};
      pending_ = -1;
    }
    for (std::size_t k = first; k < last; ++k)
      mesh_.rigid_parts.push_back({index_, k, node, ends_[k] - where, ends_[k + 1] - where});
    stretches_.push_back({a, b, node, where});
    end_ = {node, b - where};
    return last;
  }

  /// Places beside the cracks of a section that begins at `a`. The inertia of the element in which a crack
  /// stands knows nothing of its kink; where the element is short that costs nothing: the error goes with
  /// the square of its length.
  std::vector<double> beside_cracks(const Section& s, double a,
                                    const std::vector<double>& stations) const {
    std::vector<double> out;
    const double b = a + s.length;
    for (const model::Crack& c : model_.cracks) {
      const double here = c.at.s;
      if (c.to || static_cast<Index>(c.at.shaft) != index_) continue;
      if (here < a - tolerance_ || here > b + tolerance_) continue;
      const double step = step_beside_crack(s, here - a);
      for (const double place : {here - step, here + step}) {
        // one that is nearly there already takes its part
        const double farther = here + 1.5 * (place - here);
        const auto taken = [this, here, farther](double x) {
          return std::abs(x - here) > tolerance_ && (x - here) * (x - farther) <= 0.0;
        };
        if (place > a + tolerance_ && place < b - tolerance_ && !taken(a) && !taken(b) &&
            std::none_of(stations.begin(), stations.end(), taken))
          out.push_back(place);
      }
    }
    return out;
  }

  /// m; infinite where the section has no mass, or no crack can stand in it.
  double step_beside_crack(const Section& s, double from_left) const {
    constexpr double share_of_diameter = 0.05, least_share_of_shaft = 1e-3;
    if (s.general || s.is_full()) return infinity;
    double diameter = s.od_l + (s.od_r - s.od_l) * from_left / s.length;
    if (s.constants) {
      if (!(s.constants->rhoA > 0)) return infinity;
      diameter = 4.0 * std::sqrt(s.constants->EI / s.constants->EA);
    } else if (s.material < model_.materials.size() && !(model_.materials[s.material].rho > 0)) {
      return infinity;
    }
    return std::max(share_of_diameter * diameter, least_share_of_shaft * line_.length);
  }

  std::size_t flexible(std::size_t k) {
    const Section& s = shaft_.sections[k];
    const double a = ends_[k], b = ends_[k + 1];
    std::vector<double> cuts{a};
    std::vector<double> inside = shaft_.path.joints();
    for (const Attached* x : attached_)
      inside.push_back(x->where->s);
    const std::vector<double> beside = beside_cracks(s, a, inside);
    inside.insert(inside.end(), beside.begin(), beside.end());
    std::sort(inside.begin(), inside.end());
    for (const double cut : inside)
      if (cut > cuts.back() + tolerance_ && cut < b - tolerance_) cuts.push_back(cut);
    cuts.push_back(b);
    const int least =
        std::max({s.min_elements, model_.min_elements, 1}) + static_cast<int>(beside.size());
    const std::vector<int> n =
        element_counts(cuts, model::longest_element(model_, shaft_, s, resolution_), least);
    if (k == 0) end_ = {add_node(a), 0.0};
    const bool rigid_next = k + 1 < shaft_.sections.size() && shaft_.sections[k + 1].rigid;
    for (std::size_t c = 0; c < n.size(); ++c)
      for (int i = 0; i < n[c]; ++i) {
        throw_if_interrupted();
        const double h = cuts[c + 1] - cuts[c];
        const auto point = [&](int j) { return j == n[c] ? cuts[c + 1] : cuts[c] + h * j / n[c]; };
        Element e;
        e.line = index_;
        e.section = k;
        e.s1 = point(i);
        e.s2 = point(i + 1);
        e.xi1 = (e.s1 - a) / s.length;
        e.xi2 = e.s2 == b ? 1.0 : (e.s2 - a) / s.length;
        e.left = end_;
        mesh_.elements.push_back(e);
        if (e.s2 == b && rigid_next) {
          pending_ = static_cast<Index>(mesh_.elements.size()) -
                     1;  // its right end is the node of the rigid stretch
        } else {
          end_ = {add_node(e.s2), 0.0};
          mesh_.elements.back().right = end_;
        }
      }
    return k + 1;
  }

  void add_stations() {
    std::vector<Station> found;
    const auto add = [&](double s, std::string label) {
      Station x;
      x.line = index_;
      x.s = s;
      if (!label.empty()) x.labels.push_back(std::move(label));
      found.push_back(std::move(x));
    };
    for (std::size_t k = 0; k < shaft_.sections.size(); ++k) {
      const std::string& name = shaft_.sections[k].name;
      add(ends_[k], name.empty() ? name : name + ":start");
      add(ends_[k + 1], name.empty() ? name : name + ":end");
    }
    for (Index i = line_.first_node; i < line_.first_node + line_.nodes; ++i)
      add(mesh_.nodes[at(i)].s, {});
    for (const Attached* a : attached_)
      add(std::clamp(a->where->s, 0.0, line_.length), a->label);
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.s < b.s; });
    // Merge what stands at one place; section ends come before attachments in the list, so they
    // give the exact distance.
    std::vector<Station> merged;
    for (Station& x : found) {
      if (merged.empty() || x.s > merged.back().s + tolerance_)
        merged.push_back(std::move(x));
      else
        for (auto& l : x.labels)
          if (std::find(merged.back().labels.begin(), merged.back().labels.end(), l) ==
              merged.back().labels.end())
            merged.back().labels.push_back(std::move(l));
    }
    for (Station& x : merged) {
      throw_if_interrupted();
      x.position = shaft_.position(x.s);
      resolve(x);
      mesh_.stations.push_back(std::move(x));
    }
    line_.stations = static_cast<Index>(mesh_.stations.size()) - line_.first_station;
  }

  void resolve(Station& x) const {
    const auto begin = mesh_.elements.begin() + line_.first_element, end = begin + line_.elements;
    const auto right = std::lower_bound(begin, end, x.s - tolerance_,
                                        [](const Element& e, double v) { return e.s1 < v; });
    if (right != end && right->s1 <= x.s + tolerance_) {
      x.at = right->left;
      x.element = right - mesh_.elements.begin();
      return;
    }
    if (right != begin && std::abs((right - 1)->s2 - x.s) <= tolerance_) {
      x.at = (right - 1)->right;
      x.element = right - 1 - mesh_.elements.begin();
      return;
    }
    for (const Stretch& r : stretches_)
      if (x.s >= r.a - tolerance_ && x.s <= r.b + tolerance_) {
        x.at = {r.node, x.s - r.where};
        return;
      }
    x.at = end_;  // a line without sections
  }

  struct Stretch {
    double a, b;
    Index node;
    double where;
  };
  const Model& model_;
  const model::Resolution& resolution_;
  const Shaft& shaft_;
  Mesh& mesh_;
  Index index_;
  Line line_;
  double tolerance_ = 0;
  std::vector<double> ends_;
  std::vector<const Attached*> attached_;
  std::vector<Stretch> stretches_;
  Place end_;           ///< right end of what is meshed so far
  Index pending_ = -1;  ///< element whose right end is the node of the next rigid stretch
};

Index add_fixed(Mesh& mesh, const Vec3& position, NodeKind kind, std::string name) {
  WHIRL_EXPECTS(position.allFinite());
  Node n;
  n.position = position;
  n.kind = kind;
  n.name = std::move(name);
  mesh.nodes.push_back(std::move(n));
  return static_cast<Index>(mesh.nodes.size()) - 1;
}

void add_supports(const Model& m, Mesh& mesh) {
  for (std::size_t k = 0; k < m.bearings.size(); ++k) {
    const auto& b = m.bearings[k];
    BearingNodes x;
    x.shaft = mesh.place(b.at);
    x.other.node = -1;
    const bool rigid = model::traits_of(b.law).acts == model::Acts::as_constraint;
    if (b.to)
      x.other = mesh.place(*b.to);
    else if ((b.pedestal || m.foundation_of(k) >= 0) && !rigid) {
      x.pedestal = add_fixed(mesh, mesh.station(b.at).position, NodeKind::pedestal,
                             fmt::format("pedestal of {}", named("bearing", b)));
      x.other = {x.pedestal, 0.0};
    }
    mesh.bearings.push_back(x);
  }
  for (std::size_t k = 0; k < m.bearings.size(); ++k) {
    const auto& b = m.bearings[k];
    BearingNodes& x = mesh.bearings[k];
    const bool alone = model::traits_of(b.law).acts != model::Acts::between_nodes;
    if (!b.pedestal && (b.to || alone)) continue;
    x.ground = add_fixed(mesh, mesh.station(b.at).position, NodeKind::ground,
                         fmt::format("ground of {}", named("bearing", b)));
    if (x.other.node < 0 && !alone) x.other = {x.ground, 0.0};
  }
}

}  // namespace

std::string Station::label() const { return fmt::format("{}", fmt::join(labels, ", ")); }

const Station& Mesh::station(const model::Location& where) const {
  const Line& line = lines.at(where.shaft);
  const auto begin = stations.begin() + line.first_station, end = begin + line.stations;
  auto x =
      std::lower_bound(begin, end, where.s, [](const Station& a, double s) { return a.s < s; });
  if (x == end || (x != begin && where.s - (x - 1)->s < x->s - where.s)) --x;
  if (std::abs(x->s - where.s) > 2 * same_place * line.length)
    throw Error(Exit::internal,
                Diagnostic{Diagnostic::Severity::error,
                           "",
                           fmt::format("no station at {} m of '{}'", where.s, line.name),
                           {},
                           where.where});
  return *x;
}

double Mesh::radius(const model::Model& m, std::size_t line, double s) const {
  WHIRL_EXPECTS(line < lines.size());
  const Shaft& shaft = m.shafts.at(line);
  const double tolerance = same_place * lines.at(line).length;
  double start = 0, r = 0;
  for (const Section& k : shaft.sections) {
    const double end = start + k.length;
    if (s >= start - tolerance && s <= end + tolerance)
      r = std::max(
          r, 0.5 * (k.od_l + (k.od_r - k.od_l) * std::clamp((s - start) / k.length, 0.0, 1.0)));
    start = end;
  }
  return r;
}

Mesh make_mesh(const Model& m) {
  const std::vector<Attached> attached = attachments(m);
  check_model(m, attached);
  Mesh mesh;
  const model::Resolution resolution = model::resolution_of(m);
  for (std::size_t k = 0; k < m.shafts.size(); ++k)
    LineMesher(m, k, attached, resolution, mesh).run();
  add_supports(m, mesh);
  return mesh;
}

}  // namespace whirl::meshes
