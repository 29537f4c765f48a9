#include "models.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <meshes/halved.hpp>
#include <meshes/mesh.hpp>
#include <meshes/mesh_tables.hpp>

#include <algorithm>
#include <random>

using namespace whirl;
using namespace whirl::meshes;
using namespace whirl::test;

namespace {

/// What every mesh must satisfy.
/// rounding: of node positions, relative to the length of the line.
void check_invariants(const model::Model& m, const Mesh& mesh, double rounding = 0.0) {
  ASSERT_EQ(mesh.lines.size(), m.shafts.size());
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const Line& line = mesh.lines[l];
    double last = -1;
    for (Index i = line.first_node; i < line.first_node + line.nodes; ++i) {  // left to right
      const Node& n = mesh.nodes[static_cast<std::size_t>(i)];
      EXPECT_EQ(n.line, static_cast<Index>(l));
      EXPECT_GT(n.s, last);
      EXPECT_LE((n.position - Vec3(line.origin + Vec3(n.s, 0, 0))).norm(), rounding * line.length);
      last = n.s;
    }
    Index node = line.first_node;
    double s = 0;
    for (Index k = line.first_element; k < line.first_element + line.elements; ++k) {
      const Element& e = mesh.elements[static_cast<std::size_t>(k)];
      EXPECT_EQ(e.right.node, e.left.node + 1);  // block tridiagonal
      EXPECT_GE(e.left.node, node);
      EXPECT_GE(e.s1, s);
      EXPECT_GT(e.s2, e.s1);
      for (const auto& [p, x] :
           {std::pair{e.left, e.s1}, std::pair{e.right, e.s2}})  // node + offset is the end point
        EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(p.node)].s + p.offset, x,
                    1e-12 * line.length);
      const model::Section& sec = m.shafts[l].sections[e.section];
      EXPECT_NEAR((e.xi2 - e.xi1) * sec.length, e.s2 - e.s1, 1e-12 * line.length);
      EXPECT_LE(e.s2 - e.s1, std::min(sec.max_element_length, m.max_element_length) * (1 + 1e-9));
      node = e.left.node;
      s = e.s2;
    }
    // Every section once, elements and rigid parts together.
    for (std::size_t k = 0; k < m.shafts[l].sections.size(); ++k) {
      double covered = 0;
      int count = 0;
      for (const Element& e : mesh.elements)
        if (e.line == static_cast<Index>(l) && e.section == k) {
          covered += e.s2 - e.s1;
          ++count;
        }
      for (const RigidPart& r : mesh.rigid_parts)
        if (r.line == static_cast<Index>(l) && r.section == k) covered += r.o2 - r.o1;
      EXPECT_NEAR(covered, m.shafts[l].sections[k].length, 1e-12 * line.length);
      if (!m.shafts[l].sections[k].rigid) {
        EXPECT_GE(count, std::max(m.min_elements, m.shafts[l].sections[k].min_elements));
      }
    }
    for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
      const Station& st = mesh.stations[static_cast<std::size_t>(k)];
      EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(st.at.node)].s + st.at.offset, st.s,
                  1e-9 * line.length);
    }
  }
}

TEST(Mesh, NodeAtEverySectionEndAndAttachment) {
  model::Model m =
      one_shaft({cylinder("a", 0.2, 0.04), cylinder("b", 0.3, 0.06), cylinder("c", 0.1, 0.05)});
  m.disks.push_back(disk("wheel", 0.35, 3, 0.02, 0.01));
  m.bearings.push_back(spring("left", 0.0, 1e7));
  m.bearings.push_back(spring("right", 0.55, 1e7));
  m.probes.push_back(named<model::Probe>("p", 0.1));
  const Mesh mesh = make_mesh(m);
  check_invariants(m, mesh);
  std::vector<double> s;
  for (const Node& n : mesh.nodes)
    if (n.kind == NodeKind::shaft) s.push_back(n.s);
  const std::vector<double> expected{0, 0.1, 0.2, 0.35, 0.5, 0.55, 0.6};
  ASSERT_EQ(s.size(), expected.size());
  for (std::size_t i = 0; i < s.size(); ++i)
    EXPECT_NEAR(s[i], expected[i], 1e-15);
  EXPECT_EQ(mesh.elements.size(), 6u);
  EXPECT_EQ(mesh.station(m.disks[0].at).at.node, 3);
  EXPECT_EQ(mesh.station(m.disks[0].at).label(), "disk 'wheel'");
  EXPECT_EQ(mesh.station(m.bearings[0].at).label(), "a:start, bearing 'left'");
  EXPECT_EQ(mesh.bearings.size(), 2u);
  EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(mesh.bearings[1].other.node)].kind,
            NodeKind::ground);
  EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(mesh.bearings[1].ground)].position,
            Vec3(0.55, 0, 0));
}

TEST(Mesh, RefinementByCountAndSize) {
  model::Model m = one_shaft({cylinder("a", 1.0, 0.04, 0, 8)});
  m.disks.push_back(disk("third", 1.0 / 3, 1, 1e-3, 1e-3));
  Mesh mesh = make_mesh(m);
  check_invariants(m, mesh);
  EXPECT_EQ(mesh.elements.size(), 8u);  // 3 + 5: as even as the attachment allows
  double longest = 0, shortest = 1;
  for (const Element& e : mesh.elements) {
    longest = std::max(longest, e.s2 - e.s1);
    shortest = std::min(shortest, e.s2 - e.s1);
  }
  EXPECT_NEAR(longest, 2.0 / 15, 1e-14);
  EXPECT_NEAR(shortest, 1.0 / 9, 1e-14);
  m.max_element_length = 0.1;  // exactly a tenth: no extra element from round-off
  m.disks.clear();
  EXPECT_EQ(make_mesh(m).elements.size(), 10u);
  m.shafts[0].sections[0].max_element_length = 0.03;
  EXPECT_EQ(make_mesh(m).elements.size(), 34u);
  m.min_elements = 50;
  mesh = make_mesh(m);
  EXPECT_EQ(mesh.elements.size(), 50u);
  check_invariants(m, mesh);
}

TEST(Mesh, AttachmentsAtRoundOffOfASectionEndShareItsNode) {
  model::Model m =
      one_shaft({cylinder("a", 0.1, 0.04), cylinder("b", 0.2, 0.04), cylinder("c", 0.3, 0.04)});
  m.disks.push_back(disk("d", 0.3, 1, 1e-3, 1e-3));            // 0.1 + 0.2 = 0.30000000000000004
  m.disks.push_back(disk("end", 0.6, 1, 1e-3, 1e-3));          // the sum is 0.6000000000000001
  m.disks.push_back(disk("near", 0.1 + 1e-7, 1, 1e-3, 1e-3));  // a place of its own
  const Mesh mesh = make_mesh(m);
  check_invariants(m, mesh);
  EXPECT_EQ(mesh.lines[0].nodes, 5);
  EXPECT_EQ(mesh.place(m.disks[0].at).node, 3);
  EXPECT_EQ(mesh.place(m.disks[1].at).node, 4);
  EXPECT_EQ(mesh.place(m.disks[2].at).node, 2);
}

TEST(Mesh, ConicalSectionsSplitConsistently) {
  model::Model m = one_shaft({cylinder("cone", 0.6, 0.04, 0.01, 3)});
  m.shafts[0].sections[0].od_r = 0.1;
  const Mesh mesh = make_mesh(m);
  const std::string csv = elements_csv(m, mesh);
  EXPECT_NE(csv.find("0.08,0.01,0.1,0.01"), std::string::npos) << csv;  // last third
  EXPECT_NEAR(mesh.radius(m, 0, 0.3), 0.035, 1e-15);
  for (std::size_t k = 0; k + 1 < mesh.elements.size(); ++k)
    EXPECT_EQ(mesh.elements[k].xi2, mesh.elements[k + 1].xi1);
}

// ---------------------------------------------------------------- rigid stretches

// The paper's rotor: a rigid massless rod, springs at its left end, the disk at its right end: one
// node, at the disk.
TEST(Mesh, RigidRodIsOneNodeAtTheHeaviestBody) {
  model::Model m = one_shaft({rigid("rod", 0.75)});
  m.disks.push_back(disk("light", 0.2, 0.1, 1e-3, 1e-3));
  m.disks.push_back(disk("disk", 0.75, 5, 0.156, 0.078));
  auto b = named<model::Bearing>("block", 0.0);
  b.law = model::SpringBlock{2000, 500};
  m.bearings.push_back(b);
  const Mesh mesh = make_mesh(m);
  check_invariants(m, mesh);
  ASSERT_EQ(mesh.lines[0].nodes, 1);
  EXPECT_TRUE(mesh.elements.empty());
  EXPECT_EQ(mesh.nodes[0].s, 0.75);
  EXPECT_EQ(mesh.place(m.disks[1].at).offset, 0.0);
  EXPECT_EQ(mesh.place(m.bearings[0].at).offset, -0.75);
  EXPECT_NEAR(mesh.place(m.disks[0].at).offset, -0.55, 1e-15);
  EXPECT_EQ(mesh.station(m.bearings[0].at).element, -1);
}

TEST(Mesh, RigidStretchBetweenFlexibleSections) {
  model::Model m =
      one_shaft({rigid("stub", 0.1), cylinder("a", 0.2, 0.04, 0, 2), rigid("hub1", 0.05),
                 rigid("hub2", 0.15, 0.2), cylinder("b", 0.3, 0.04)});
  Mesh mesh = make_mesh(m);
  check_invariants(m, mesh);
  ASSERT_EQ(mesh.lines[0].nodes, 4);          // stub, middle of a, hub, right end
  EXPECT_NEAR(mesh.nodes[0].s, 0.05, 1e-15);  // the middle of the stub
  EXPECT_NEAR(mesh.nodes[2].s, 0.4, 1e-15);   // the middle of the hub
  EXPECT_EQ(mesh.elements[0].left.node, 0);
  EXPECT_NEAR(mesh.elements[0].left.offset, 0.05, 1e-15);
  EXPECT_NEAR(mesh.elements[1].right.offset, -0.1, 1e-15);
  EXPECT_NEAR(mesh.elements[2].left.offset, 0.1, 1e-15);
  ASSERT_EQ(mesh.rigid_parts.size(), 3u);
  EXPECT_NEAR(mesh.rigid_parts[2].o1, -0.05, 1e-15);
  EXPECT_NEAR(mesh.rigid_parts[2].o2, 0.1, 1e-15);
  EXPECT_EQ(mesh.elements[1].line, 0);

  // A rigid support decides before any mass: what is held must be unknowns of the node.
  m.disks.push_back(disk("heavy", 0.45, 50, 1, 1));
  m.bearings.push_back(held("pin", 0.32, {true, true, true, false, false, false}));
  mesh = make_mesh(m);
  check_invariants(m, mesh);
  EXPECT_EQ(mesh.place(m.bearings[0].at).offset, 0.0);
  EXPECT_NEAR(mesh.place(m.disks[0].at).offset, 0.13, 1e-15);
}

// ---------------------------------------------------------------- several lines, pedestals

TEST(Mesh, TwoSpoolsCasingAndPedestals) {
  model::Model m = one_shaft({cylinder("lp", 1.0, 0.04, 0, 4)}, "lp");
  for (const char* name : {"hp", "casing"}) {
    model::Shaft s;
    s.name = name;
    s.origin = Vec3(0.2, 0, 0);
    s.rotating = std::string(name) == "hp";
    s.sections = {cylinder("tube", 0.5, 0.12, 0.1, 2)};
    m.shafts.push_back(s);
  }
  auto inter = spring("inter", 0.7, 1e7);
  inter.to = place(0.5, 1);
  m.bearings.push_back(inter);
  auto outer = spring("outer", 0.0, 1e7, 0, 1);
  outer.pedestal = model::Pedestal{20, 1e8 * Mat3::Identity(), Mat3::Zero()};
  m.bearings.push_back(outer);
  auto pinned = held("pinned", 0.0, {true, true, true, false, false, false}, 2);
  m.bearings.push_back(pinned);
  const Mesh mesh = make_mesh(m);
  check_invariants(m, mesh);
  EXPECT_EQ(mesh.lines[0].nodes, 5);  // 3 elements left of the bearing at 0.7 m, 1 right of it
  EXPECT_EQ(mesh.lines[1].first_node, 5);
  EXPECT_FALSE(mesh.lines[2].rotating);
  EXPECT_EQ(mesh.bearings[0].other.node, mesh.lines[1].first_node + 2);
  EXPECT_EQ(mesh.bearings[0].ground, -1);
  EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(mesh.bearings[1].pedestal)].kind,
            NodeKind::pedestal);
  EXPECT_EQ(mesh.bearings[1].other.node, mesh.bearings[1].pedestal);
  EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(mesh.bearings[1].ground)].kind, NodeKind::ground);
  EXPECT_GT(mesh.bearings[1].ground, mesh.bearings[1].pedestal);
  EXPECT_EQ(mesh.bearings[2].other.node, -1);
  EXPECT_EQ(mesh.bearings[2].ground, -1);
  EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(mesh.lines[2].first_node)].name,
            "node at 0 m of casing 'casing'");
}

TEST(Mesh, RandomShaftsKeepTheInvariants) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<model::Section> sections;
    const int n = 1 + static_cast<int>(u(random) * 8);
    for (int k = 0; k < n; ++k) {
      const double length = std::pow(10, -4 + 4 * u(random));
      sections.push_back(u(random) < 0.3 ? rigid(fmt::format("r{}", k), length)
                                         : cylinder(fmt::format("f{}", k), length, 0.05, 0,
                                                    1 + static_cast<int>(3 * u(random))));
    }
    model::Model m = one_shaft(sections);
    if (u(random) < 0.5) m.max_element_length = 0.02 + u(random);
    const double L = m.shafts[0].length();
    for (int k = 0; k < 6; ++k)
      m.disks.push_back(disk(fmt::format("d{}", k), L * u(random), u(random), 1e-3, 1e-3));
    m.disks.push_back(disk("left", 0, 1, 1, 1));
    m.disks.push_back(disk("right", L, 1, 1, 1));
    SCOPED_TRACE(trial);
    const Mesh mesh = make_mesh(m);
    check_invariants(m, mesh);
    const Halved fine = halve(mesh, {true});
    EXPECT_EQ(fine.mesh.elements.size(), 2 * mesh.elements.size());
    EXPECT_EQ(fine.mesh.nodes.size(), mesh.nodes.size() + mesh.elements.size());
    check_invariants(m, fine.mesh, 1e-14);
    for (std::size_t k = 0; k < mesh.stations.size(); ++k) {  // every place stays where it was
      const Place p = fine.mesh.stations[k].at, old = mesh.stations[k].at;
      EXPECT_EQ(p.node, fine.node[static_cast<std::size_t>(old.node)]);
      EXPECT_EQ(p.offset, old.offset);
    }
    for (const auto& d : m.disks) {
      const Place p = mesh.place(d.at);
      EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(p.node)].s + p.offset, d.at.s, 2e-9 * L);
    }
    if (::testing::Test::HasFailure()) return;
  }
}

// ---------------------------------------------------------------- bad input

std::vector<Diagnostic> meshing_errors_of(const model::Model& m) {
  try {
    make_mesh(m);
  } catch (const Error& e) {
    EXPECT_EQ(e.exit(), Exit::deck);
    return e.diagnostics();
  }
  return {};
}

TEST(Mesh, AllErrorsAtOnceWithPlaceAndName) {
  model::Model m = one_shaft({cylinder("a", 0.2, 0.04), cylinder("b", 0.3, 0.06, 0.06)});
  m.shafts[0].sections[1].where.line = 7;
  m.disks.push_back(disk("wheel", 0.51, 3, 0.02, 0.01));
  m.disks[0].at.where.line = 12;
  m.probes.push_back(named<model::Probe>("p", -0.1));
  m.probes[0].at.where.line = 20;
  const auto e = meshing_errors_of(m);
  ASSERT_EQ(e.size(), 3u);
  EXPECT_EQ(e[0].code, "E23");
  EXPECT_EQ(e[0].message,
            "section 'b' of shaft 'rotor': the bore, 0.06 m, is not smaller than the outer "
            "diameter, 0.06 m");
  EXPECT_EQ(e[1].code, "E19");
  EXPECT_EQ(e[1].message,
            "disk 'wheel' stands at 0.51 m, but shaft 'rotor' reaches from 0 to 0.5 m");
  EXPECT_EQ(e[2].code, "E19");
}

TEST(Mesh, ImpossibleSections) {
  for (auto spoil :
       {+[](model::Section& s) { s.length = 0; }, +[](model::Section& s) { s.length = whirl::nan; },
        +[](model::Section& s) { s.od_r = 0; }, +[](model::Section& s) { s.min_elements = -1; },
        +[](model::Section& s) { s.max_element_length = 1e-9; },
        +[](model::Section& s) { s.constants = model::Section::Constants{}; }}) {
    model::Model m = one_shaft({cylinder("a", 0.2, 0.04)});
    spoil(m.shafts[0].sections[0]);
    const auto e = meshing_errors_of(m);
    ASSERT_EQ(e.size(), 1u);
    EXPECT_EQ(e[0].code, "E14");
  }
  model::Model none;
  EXPECT_EQ(meshing_errors_of(none).at(0).code, "E35");
}

TEST(Mesh, BodyWithoutSections) {
  model::Model m = one_shaft({});
  m.disks.push_back(disk("free", 0, 1, 1, 1));
  const Mesh mesh = make_mesh(m);
  EXPECT_EQ(mesh.nodes.size(), 1u);
  EXPECT_EQ(mesh.place(m.disks[0].at).node, 0);
}

TEST(Mesh, Tables) {
  model::Model m = one_shaft({cylinder("a, left", 0.2, 0.04, 0, 2)});
  m.bearings.push_back(spring("b", 0.0, 1e7));
  const Mesh mesh = make_mesh(m);
  EXPECT_EQ(nodes_csv(mesh),
            "node,name,kind,line,s[m],x[m],y[m],z[m]\n"
            "0,node at 0 m of shaft 'rotor',shaft,rotor,0,0,0,0\n"
            "1,node at 0.1 m of shaft 'rotor',shaft,rotor,0.1,0.1,0,0\n"
            "2,node at 0.2 m of shaft 'rotor',shaft,rotor,0.2,0.2,0,0\n"
            "3,ground of bearing 'b',ground,,0,0,0,0\n");
  EXPECT_EQ(stations_csv(mesh),
            "station,line,s[m],node,offset[m],element,labels\n"
            "0,rotor,0,0,0,0,\"a, left:start, bearing "
            "'b'\"\n1,rotor,0.1,1,0,1,\n2,rotor,0.2,2,0,1,\"a, left:end\"\n");
  EXPECT_NE(station_table(m, mesh).find("a, left:start, bearing 'b'"), std::string::npos);
}

// Unknowns that change evenly along a line do so on the halved mesh.
TEST(Mesh, StatesSpreadEvenlyOverHalvedElements) {
  model::Model m = one_shaft({cylinder("a", 0.2, 0.04, 0, 2), cylinder("b", 0.6, 0.05, 0, 3)});
  m.bearings.push_back(spring("b", 0.0, 1e7));
  const Mesh mesh = make_mesh(m);
  const auto unknowns = [](const Mesh& of) {
    VecX x(6 * static_cast<Index>(of.nodes.size()));
    for (Index n = 0; n < x.size() / 6; ++n)
      for (int c = 0; c < 6; ++c)
        x[6 * n + c] = (c + 1) * of.nodes[static_cast<std::size_t>(n)].s - 0.1 * c;
    return x;
  };
  const Halved fine = halve(mesh, std::vector<bool>(mesh.lines.size(), true));
  ASSERT_EQ(fine.middles.size(), 5u);
  EXPECT_LT((spread(fine, unknowns(mesh)) - unknowns(fine.mesh)).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
