// What a step costs as physics is absent, what the program costs before and after the first step,
// and what a run of a sweep costs beyond its analysis. Prints Markdown tables:
//   build/bin/bench_scenes build/bin/whirl .
#include <run/job.hpp>
#include <deck/deck.hpp>
#include <steps/steps.hpp>
#include <steps/transient_step.hpp>
#include <core/stopwatch.hpp>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

fs::path scratch() {
  return fs::temp_directory_path() / ("whirl_bench_" + std::to_string(::getpid()));
}

struct Cost {
  long steps = 0;
  double newton = 0, factorisations = 0, micro = 0, seconds = 0;
};

/// The fastest of three runs of the deck's first step, without outputs but for `observers`.
Cost measure(const model::Model& m) {
  run::RunOptions options;
  options.quiet = true;
  run::Job job(m, options, scratch());
  const model::Step& step = m.steps.front();
  const auto& law = std::get<model::TransientStep>(m.steps.front().law);
  job.build_for(step);
  const run::StepState start = steps::transient_start(job, step, law);
  Cost best;
  for (int k = 0; k < 3; ++k) {
    const auto problem = steps::transient_problem(job, law, start);
    const analysis::TransientResult r = analysis::run_transient(
        *problem, start.state, steps::transient_options(job, law, start.state.t), {});
    if (r.reason != analysis::StopReason::end_time)
      std::printf("<!-- %s %s -->\n", std::string(to_string(r.reason)).c_str(), r.detail.c_str());
    if (k > 0 && r.seconds > best.seconds) continue;
    const double n = static_cast<double>(r.statistics.accepted);
    best = {r.statistics.accepted, static_cast<double>(r.statistics.newton_iterations) / n,
            static_cast<double>(r.statistics.factorizations_real +
                                r.statistics.factorizations_complex) /
                n,
            1e6 * r.seconds / n, r.seconds};
  }
  return best;
}

void row(const char* what, const Cost& c) {
  std::printf("| %s | %ld | %.2f | %.2f | %.1f | %.4f |\n", what, c.steps, c.newton,
              c.factorisations, c.micro, c.seconds);
  std::fflush(stdout);
}

/// CPU and wall time, peak memory of a child process: the least of several.
struct Process {
  double wall = infinity, cpu = infinity, megabytes = 0;
};
Process measured(const std::vector<std::string>& arguments, int repeats) {
  Process best;
  for (int k = 0; k < repeats; ++k) {
    const auto t0 = std::chrono::steady_clock::now();
    std::fflush(stdout);  // or the child writes it again
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> argv;
      for (const std::string& a : arguments)
        argv.push_back(const_cast<char*>(a.c_str()));
      argv.push_back(nullptr);
      if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
        _exit(126);
      execv(argv[0], argv.data());
      _exit(127);
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
      std::printf("<!-- %s failed -->\n", arguments.back().c_str());
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    best.wall = std::min(
        best.wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count());
    best.cpu = std::min(best.cpu, seconds(usage.ru_utime) + seconds(usage.ru_stime));
    best.megabytes = static_cast<double>(usage.ru_maxrss) / 1024.0;
  }
  return best;
}

/// A shaft with a disk in its middle, on two linear bearings: elements on either side, the step.
fs::path write_rotor(const char* name, int half, const std::string& step) {
  const std::string ends =
      "type = 'linear'\nkyy = '1e7 N/m'\nkzz = '8e6 N/m'\ncyy = '500 N.s/m'\nczz = '500 N.s/m'\n";
  const fs::path file = scratch() / name;
  std::ofstream(file)
      << "format = 1\n[model]\ngravity = '9.81 m/s^2'\ngravity_direction = '-y'\n"
      << "[[material]]\nname = 'own'\nE = '210 GPa'\nnu = 0.3\ndensity = '7850 kg/m^3'\n"
      << "[shaft]\nmaterial = 'own'\ncolumns = ['name', 'length[mm]', 'od[mm]', 'min_elements']\n"
      << fmt::format("rows = [['left', 750, 50, {0}], ['right', 750, 50, {0}]]\n", half)
      << "[[disk]]\nname = 'disk'\nat = 'left:end'\nmass = '30 kg'\nIp = '0.3 kg.m^2'\n"
      << "Id = '0.15 kg.m^2'\n[[unbalance]]\nat = 'disk'\namount = '300 g.mm'\n"
      << "[[bearing]]\nname = 'driven'\nat = 'left:start'\nkxx = '1e7 N/m'\ncxx = '10 N.s/m'\n"
      << ends << "[[bearing]]\nname = 'free'\nat = 'right:end'\n"
      << ends << "[[probe]]\nname = 'disk'\nat = 'disk'\n"
      << "[[drive]]\nname = 'motor'\nat = 'left:start'\ntype = 'speed'\nspeed = '3000 rpm'\n"
      << "[[step]]\nname = 'step'\n"
      << step;
  return file;
}

/// CPU time of the steps of a model alone, s: the median of many in a process that is warm.
double steps_alone(const model::Model& m, const std::string& table) {
  run::RunOptions options;
  options.quiet = true;
  options.jobs = 1;
  options.only_files = {table};
  std::vector<double> seconds;
  for (int k = 0; k < 300; ++k) {
    fs::remove_all(scratch() / "alone");
    const Stopwatch watch;
    run::Job job(m, options, scratch() / "alone");
    steps::run_steps(job);
    seconds.push_back(watch.elapsed().cpu);
  }
  std::nth_element(seconds.begin(), seconds.begin() + 150, seconds.end());
  return seconds[150];
}

/// What many short runs cost beyond their analyses.
void print_sweep(const std::string& whirl) {
  const fs::path deck = write_rotor("modal.toml", 10, "type = 'modal'\nspeed = '3000 rpm'\n");
  constexpr int runs = 2000;
  deck::ReadOptions tables;
  tables.set = {"output.report=false", "output.vtk=[]"};
  const double alone = steps_alone(deck::load_model(deck, tables), "step_modes.csv");
  std::printf(
      "\n`whirl sweep`, %d runs of a modal step of 20 elements, whose steps alone take %.2f ms of "
      "CPU time each:\n\n"
      "| processes | wall, s | CPU a run, ms | analyses / (wall x processes), %% "
      "|\n|---|---|---|---|\n",
      runs, 1e3 * alone);
  for (const int jobs : {1, 2}) {
    fs::remove_all(scratch() / "sweep");
    const Process p = measured(
        {whirl, "sweep", deck.string(), "--quiet", "--vary",
         fmt::format("disk.disk.mass=20kg:40kg:{}", runs), "--response", "f=step_modes:frequency:1",
         "--jobs", std::to_string(jobs), "--output", (scratch() / "sweep").string()},
        1);
    std::printf("| %d | %.2f | %.2f | %.0f |\n", jobs, p.wall, 1e3 * p.cpu / runs,
                100.0 * alone * runs / (p.wall * jobs));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("bench_scenes WHIRL SOURCE_FOLDER\n", stderr), 2;
  const fs::path source = argv[2];
  const model::Model base = [&] {
    model::Model m = deck::load_model(source / "examples/12_blade_loss/deck.toml", {});
    m.events.clear();  // nothing stops the run
    return m;
  }();
  auto law = [](model::Model& m) -> model::TransientStep& {
    return std::get<model::TransientStep>(m.steps.front().law);
  };

  std::printf(
      "A rotor of 15 elements and three disks (example 12: blade loss at 6000 rpm), 1 s, radau5 at "
      "1e-4; CPU time of one core.\n\n");
  std::printf(
      "| scene | steps | Newton iterations a step | factorisations a step | us a step | s "
      "|\n|---|---|---|---|---|---|\n");
  model::Model m = base;
  m.keep_everything = true;
  row("`--keep-everything`: the general model", measure(m));
  row("the deck as it is", measure(base));
  m = base;
  law(m).start = model::TransientStep::Start::static_equilibrium;
  m.drives.clear();
  law(m).speed0 = 6000 * pi / 30;
  row("free spin instead of a prescribed speed", measure(m));
  m = base;
  for (auto& s : m.shafts)
    s.damping = {};
  row("without internal damping", measure(m));
  m = base;
  law(m).linear = true;
  row("linear = true", measure(m));
  law(m).integrator.dt = 4e-4;
  row("linear = true, equal steps of 0.4 ms", measure(m));
  m = base;
  m.unbalances.clear();
  law(m).start = model::TransientStep::Start::static_equilibrium;
  row("balanced", measure(m));
  m.drives.clear();
  law(m).speed0 = 0;
  row("balanced, at rest", measure(m));
  // A force steps up at 10 ms; what it does not excite is held.
  model::PointLoad step_load;
  step_load.name = "step";
  step_load.at = m.disks.at(1).at;
  step_load.force[1] = 1000.0;
  step_load.factor = make_table({0.0, 0.01, 0.0101}, {0.0, 0.0, 1.0});
  m.gravity = Vec3::Zero();
  m.loads = {step_load};
  row("at rest, a step force in one plane: the other plane, torsion and axial motion are held",
      measure(m));
  step_load.force[2] = 1000.0;
  m.loads = {step_load};
  row("at rest, a step force in both planes", measure(m));
  row("one disk on a spring, prescribed angle (example 09, 6 s at 1e-7): constant matrices",
      measure(deck::load_model(source / "examples/09_jeffcott_run_up/deck.toml", {})));
  row("one rigid body (example 01, 10 s)",
      measure(deck::load_model(source / "examples/01_paper_rotor/deck.toml", {})));

  std::printf(
      "\nThe whole process:\n\n| command | wall, ms | CPU, ms | peak memory, MB "
      "|\n|---|---|---|---|\n");
  fs::create_directories(scratch());
  const std::string out = (scratch() / "out").string();
  auto process = [&](const char* what, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), argv[1]);
    const Process p = measured(arguments, 5);
    std::printf("| %s | %.1f | %.1f | %.1f |\n", what, 1e3 * p.wall, 1e3 * p.cpu, p.megabytes);
  };
  process("`whirl version`", {"version"});
  {
    std::ifstream in(source / "examples/01_paper_rotor/deck.toml");
    std::string text((std::istreambuf_iterator<char>(in)), {});
    std::ofstream(scratch() / "disk.toml")
        << text.substr(0, text.find("[[output.vtk]]"));  // without frames
  }
  const std::string disk = (scratch() / "disk.toml").string();
  process("`whirl check`, one disk", {"check", disk});
  process("`whirl run`, one disk, no outputs",
          {"run", disk, "--quiet", "--output", out, "--set", "output.csv=false", "--set",
           "output.report=false"});
  process("`whirl run`, one disk, histories and report", {"run", disk, "--quiet", "--output", out});
  process("`whirl run`, example 12, no outputs",
          {"run", (source / "examples/12_blade_loss/deck.toml").string(), "--quiet", "--output",
           out, "--set", "output.csv=false", "--set", "output.report=false"});
  process(
      "`whirl run`, example 12, histories, spectra and report",
      {"run", (source / "examples/12_blade_loss/deck.toml").string(), "--quiet", "--output", out});
  process(
      "`whirl run`, example 30: static",
      {"run", (source / "examples/30_static_sag/deck.toml").string(), "--quiet", "--output", out});
  const std::vector<std::string> alone{
      "--quiet",  "--jobs", "1", "--set", "output.csv=false", "--set", "output.report=false",
      "--output", out};
  const auto by_itself = [&](const char* what, const fs::path& deck) {
    std::vector<std::string> arguments{"run", deck.string()};
    arguments.insert(arguments.end(), alone.begin(), alone.end());
    process(what, arguments);
  };
  by_itself("`linear = true`, 50 elements, 1000 steps of 1 ms by Gauss 6, no outputs",
            write_rotor("linear.toml", 25,
                        "type = 'transient'\nlinear = true\nstart = 'static'\nduration = '1 s'\n"
                        "integrator = { method = 'gauss6', dt = '1 ms' }\n"));
  by_itself("`unbalance_response`, 400 elements, 250 speeds and more at peaks, no outputs",
            write_rotor("unbalance.toml", 200,
                        "type = 'unbalance_response'\n"
                        "speed = { start = '100 rpm', stop = '12000 rpm', points = 250 }\n"));
  print_sweep(argv[1]);
  std::printf("\nThe program: %.1f MB.\n", static_cast<double>(fs::file_size(argv[1])) / 1048576.0);
  fs::remove_all(scratch());
  return 0;
}
