#include <core/contract.hpp>
#include <meshes/halved.hpp>

#include <fmt/format.h>

namespace whirl::meshes {
namespace {

class Halving {
 public:
  Halving(const Mesh& mesh, const std::vector<bool>& lines)
      : old_(mesh),
        lines_(lines),
        middle_(mesh.elements.size(), -1),
        first_half_(mesh.elements.size(), 0) {
    out_.mesh = mesh;
  }

  Halved run() {
    number_nodes();
    divide_elements();
    for (RigidPart& r : out_.mesh.rigid_parts)
      r.node = moved(r.node);
    for (Station& s : out_.mesh.stations)
      move_station(s);
    for (BearingNodes& b : out_.mesh.bearings) {
      b.shaft.node = moved(b.shaft.node);
      b.other.node = moved(b.other.node);
      b.pedestal = moved(b.pedestal);
      b.ground = moved(b.ground);
    }
    for (Line& l : out_.mesh.lines)
      move_line(l);
    for (Halved::Middle& m : out_.middles)
      m.between = {moved(m.between[0]), moved(m.between[1])};
    return std::move(out_);
  }

 private:
  bool divides(const Element& e) const { return lines_[static_cast<std::size_t>(e.line)]; }
  Index moved(Index node) const { return node < 0 ? node : out_.node[at(node)]; }
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  /// A new node follows the left one of its element.
  void number_nodes() {
    std::vector<Index> element_right_of(old_.nodes.size(), -1);
    for (std::size_t e = 0; e < old_.elements.size(); ++e)
      if (divides(old_.elements[e]))
        element_right_of[at(old_.elements[e].left.node)] = static_cast<Index>(e);
    out_.mesh.nodes.clear();
    for (std::size_t n = 0; n < old_.nodes.size(); ++n) {
      out_.node.push_back(static_cast<Index>(out_.mesh.nodes.size()));
      out_.mesh.nodes.push_back(old_.nodes[n]);
      if (element_right_of[n] >= 0) add_middle(at(element_right_of[n]));
    }
  }

  void add_middle(std::size_t e) {
    const Element& element = old_.elements[e];
    const Index left = element.left.node, right = element.right.node;
    Node middle = old_.nodes[at(left)];
    middle.s = 0.5 * (element.s1 + element.s2);
    const double from = old_.nodes[at(left)].s, to = old_.nodes[at(right)].s;
    const double share = (middle.s - from) / (to - from);
    middle.position += share * (old_.nodes[at(right)].position - middle.position);
    middle.name =
        fmt::format("node at {:g} m of shaft '{}'", middle.s, old_.lines[at(element.line)].name);
    middle_[e] = static_cast<Index>(out_.mesh.nodes.size());
    out_.middles.push_back({middle_[e], {left, right}});
    out_.mesh.nodes.push_back(std::move(middle));
  }

  void divide_elements() {
    out_.mesh.elements.clear();
    for (std::size_t e = 0; e < old_.elements.size(); ++e) {
      Element whole = old_.elements[e];
      whole.left.node = moved(whole.left.node);
      whole.right.node = moved(whole.right.node);
      first_half_[e] = static_cast<Index>(out_.mesh.elements.size());
      if (middle_[e] < 0) {
        out_.mesh.elements.push_back(whole);
        continue;
      }
      Element left = whole, right = whole;
      left.right = right.left = Place{middle_[e], 0.0};
      left.s2 = right.s1 = 0.5 * (whole.s1 + whole.s2);
      left.xi2 = right.xi1 = 0.5 * (whole.xi1 + whole.xi2);
      out_.mesh.elements.push_back(left);
      out_.mesh.elements.push_back(right);
    }
  }

  void move_station(Station& s) const {
    s.at.node = moved(s.at.node);
    if (s.element < 0) return;
    const std::size_t e = at(s.element);
    const bool at_its_right =
        middle_[e] >= 0 && s.s > 0.5 * (old_.elements[e].s1 + old_.elements[e].s2);
    s.element = first_half_[e] + (at_its_right ? 1 : 0);
  }

  void move_line(Line& l) const {
    const Index last = l.first_node + l.nodes - 1;
    const Index first_element = l.first_element, end = l.first_element + l.elements;
    l.first_node = moved(l.first_node);
    l.nodes = moved(last) - l.first_node + 1;
    if (l.elements == 0) return;
    l.first_element = first_half_[at(first_element)];
    l.elements = first_half_[at(end - 1)] + (middle_[at(end - 1)] >= 0 ? 2 : 1) - l.first_element;
  }

  const Mesh& old_;
  const std::vector<bool>& lines_;
  std::vector<Index> middle_;      ///< new node of an element, or -1
  std::vector<Index> first_half_;  ///< new number of an element, or of its left half
  Halved out_;
};

}  // namespace

Halved halve(const Mesh& mesh, const std::vector<bool>& lines) {
  WHIRL_EXPECTS(lines.size() == mesh.lines.size());
  return Halving(mesh, lines).run();
}

VecX spread(const Halved& fine, const VecX& x) {
  const Index added = static_cast<Index>(fine.middles.size());
  const Index nodes = x.size() / 6;
  VecX out = VecX::Zero(x.size() + 6 * added);
  for (Index n = 0; n < nodes; ++n) {
    const bool in_mesh = n < static_cast<Index>(fine.node.size());
    const Index to = in_mesh ? fine.node[static_cast<std::size_t>(n)] : n + added;
    out.segment<6>(6 * to) = x.segment<6>(6 * n);
  }
  for (const meshes::Halved::Middle& m : fine.middles)
    out.segment<6>(6 * m.node) =
        0.5 * (out.segment<6>(6 * m.between[0]) + out.segment<6>(6 * m.between[1]));
  return out;
}

}  // namespace whirl::meshes
