// The deck as a whole: its top-level keys and [model].
#include <deck/visitor.hpp>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

void describe_settings(Visitor& v, model::Model& m) {
  static constexpr Option directions[] = {{"+x", "along the shaft"},
                                          {"-x", "against it"},
                                          {"+y", ""},
                                          {"-y", ""},
                                          {"+z", "up"},
                                          {"-z", "down"}};
  static constexpr Option axes[] = {
      {"x", "shaft lines run along +x; y and z are the lateral directions"}};
  int axis = 0, direction = 5;
  double g = 9.80665;
  std::vector<double> components;
  v.option("axis", axis, axes, "direction of the shaft lines");
  const bool vector =
      v.quantities(optional("gravity_vector", "from gravity and gravity_direction"), components,
                   "m/s^2", any, 3, "gravity as three components, for inclined shafts");
  v.quantity(vector ? optional("gravity", "") : Key("gravity"), g, "m/s^2", not_negative,
             "acceleration of gravity; \"0 m/s^2\" switches it off");
  v.option(vector ? optional("gravity_direction", "") : Key("gravity_direction"), direction,
           directions, "where gravity points");
  m.gravity = Vec3::Zero();
  m.gravity[direction / 2] = direction % 2 == 0 ? g : -g;
  if (components.size() == 3) m.gravity = Vec3(components[0], components[1], components[2]);
  if (v.clean() && !components.empty() && (v.given("gravity") || v.given("gravity_direction")))
    v.error("E26", "gravity_vector", "gravity is given by components and by magnitude or direction",
            "keep one of the two");
  v.flag(
      "chart_change", m.chart_change,
      "move the axes that a node's angles refer to before its tilt reaches the limit of the "
      "split rotation (pi): results do not depend on it; only what tumbles or rolls up needs it");
  v.flag("keep_everything", m.keep_everything,
         "build the general model: kernels, damping and unknowns that this deck does not need are "
         "kept instead of left out; slower, with the same results");
  v.table(
      "mesh",
      [&](Visitor& w) {
        w.quantity(optional("max_element_length", "no limit"), m.max_element_length, "mm", positive,
                   "longest shaft element");
        w.integer(optional("min_elements_per_section", "chosen by the program"), m.min_elements,
                  between(1, 10000), "least number of elements of each section");
        w.number("accuracy", m.mesh_accuracy, between(1e-8, 0.1),
                 "of frequencies, where the program chooses the elements: sections without "
                 "min_elements or max_element_length, here or of their own");
        int mass = m.consistent_mass ? 1 : 0;
        const Option kinds[] = {{"corrected", "consistent, with what raises the order"},
                                {"consistent", "as in published meshes"}};
        if (w.option("mass", mass, kinds, "mass matrices of shaft elements"))
          m.consistent_mass = mass == 1;
      },
      "elements; a node stands at every section end and at everything attached in any case");
}

}  // namespace

void describe(Visitor& v, model::Model& m) {
  v.integer(required("format"), m.format, any, "version of the deck format: 1");
  if (v.clean() && m.format != 1)
    v.error("E31", "format",
            fmt::format("the deck has format {}, this program reads format 1", m.format),
            m.format > 1 ? "a newer program is needed" : "write format = 1");
  v.text(beside_motion(optional("title", "none")), m.title, "one line for reports");
  std::vector<std::string> include;
  v.texts(optional("include", "none"), include,
          "files merged before this one: lists of tables are joined, a key set in both is a "
          "mistake; paths are relative to this file");
  v.free_table(
      optional("parameters", "none"),
      "named values, used as \"${name}\" anywhere; --set parameters.name=value overrides them");
  v.table(
      "model", [&](Visitor& w) { describe_settings(w, m); }, "settings of the whole model");
  v.list(optional("material", "built-in materials"), m.materials,
         "materials besides the built-in ones (steel, stainless_steel, titanium, aluminium, "
         "inconel_718, cast_iron)");
  v.list(required("shaft"), m.shafts, "a shaft line: sections from left to right along +x");
  if (v.clean() && v.given("shaft") && m.shafts.empty())
    v.error("E35", "shaft", "the list of shafts is empty",
            "a deck needs a [shaft] with its sections");
  v.list(optional("disk", "none"), m.disks,
         "a rigid disk or body fixed to a shaft, by mass and inertia or by its shape");
  v.list(optional("bearing", "none"), m.bearings,
         "whatever connects a shaft with the ground or another shaft");
  v.list(optional("joint", "none"), m.joints,
         "what holds two shaft lines together exactly, or one to the ground, and leaves some of "
         "their motions free: no stiffness, no play");
  v.list(optional("foundation", "none"), m.foundations,
         "a foundation or casing as reduced stiffness, damping and mass matrices, under one or "
         "more bearings");
  v.list(optional("unbalance", "none"), m.unbalances,
         "a mass times eccentricity that turns with the shaft");
  v.list(optional("crack", "none"), m.cracks,
         "a transverse crack of a shaft, which opens and closes as it turns");
  v.list(optional("load", "none"), m.loads, "forces and moments at a station");
  v.list(optional("drive", "none"), m.drives,
         "what turns a shaft: a prescribed speed or angle, or a torque");
  v.table(
      optional("base", "at rest"), [&](Visitor& w) { describe(w, m.base); },
      "motion of the base all supports stand on");
  v.list(optional("event", "none"), m.events,
         "what a transient run reports or stops at, located on its dense output");
  v.list(optional("initial", "at rest, straight"), m.initial,
         "initial motion of a shaft line as a rigid body");
  v.list(beside_motion(optional("probe", "none")), m.probes, "a place whose motion is recorded");
  v.list(optional("step", "none"), m.steps, "analyses, run in this order");
  v.table(beside_motion(optional("title_block", "none")), m.title_block,
          "what stands at the head of the report");
  v.table(beside_motion("output"), m.output, "what is written, and where");
  v.table(beside_motion(optional("sweep", "as the command line says")), m.sweep,
          "many runs with keys varied: what `whirl sweep` takes where its options do not say");
}

}  // namespace whirl::deck
