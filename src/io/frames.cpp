#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/frame_sets.hpp>
#include <io/frames.hpp>
#include <io/hdf5/entry.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <unordered_set>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

std::string shortest(double x) {
  char b[32];
  return {b, std::to_chars(b, b + sizeof b, x).ptr};
}

std::string padded(std::uint64_t k) {
  std::string s = std::to_string(k);
  return s.size() < 6 ? std::string(6 - s.size(), '0') + s : s;
}

constexpr std::string_view pvd_head =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
    "byte_order=\"LittleEndian\">\n<Collection>\n";
constexpr std::string_view pvd_foot = "</Collection>\n</VTKFile>\n";

/// One .pvd and its folder of frames. The .pvd always lists whole files and always ends in its
/// footer: a new entry and the footer after it are put over the old footer in one write. (A file
/// renamed into place for every frame costs four times the frame itself in the file system.)
class Collection {
 public:
  struct Frame {
    double time;
    std::string file;
  };
  /// kept: frames of the earlier run that stay, whose number is `next`; else those of the .pvd up
  /// to keep_until.
  Collection(const fs::path& directory, const std::string& stem, double keep_until,
             std::vector<Frame> kept = {}, std::uint64_t next = 0)
      : frames_(std::move(kept)),
        next_(next),
        pvd_(directory / (stem + ".pvd")),
        folder_(directory / stem),
        stem_(stem) {
    std::error_code ec;
    if (fs::is_symlink(fs::symlink_status(folder_, ec)))
      io_failure(folder_, "nothing is written through a symbolic link:");
    fs::create_directories(folder_, ec);
    if (ec) io_failure(folder_, "cannot make the folder", ec.value());
    const bool there = fs::exists(pvd_, ec);
    const bool earlier = there && read_text(pvd_).starts_with(pvd_head);
    if (there && !earlier) io_failure(pvd_, "no list of frames of an earlier run:");
    if (next_ == 0 && keep_until > -infinity && earlier) recover(keep_until);
    remove_unfinished_lists();
    write_list();          // before files go: the list never names a missing one
    if (!earlier) return;  // no run made frames here: whatever is in the folder is somebody else's
    std::unordered_set<std::string> listed;
    for (const auto& f : frames_)
      listed.insert(f.file);
    std::vector<fs::path> stale;
    for (const auto& f : fs::directory_iterator(folder_, ec)) {
      const std::string name = f.path().filename().string();
      if (is_frame(name) && !listed.count(name)) stale.push_back(f.path());
    }
    for (const auto& f : stale)
      fs::remove(f, ec);
  }

  fs::path next_file() const { return folder_ / ("frame_" + padded(next_) + ".vtp"); }
  std::size_t size() const { return frames_.size(); }
  const std::vector<Frame>& frames() const { return frames_; }
  std::uint64_t next() const { return next_; }

  void add(double time) {
    frames_.push_back({time, next_file().filename().string()});
    ++next_;
    const std::string entry = line(frames_.back());
    file_.put(length_, entry + std::string(pvd_foot));
    length_ += entry.size();
  }

  /// Leaves every other frame, the first one among them.
  void thin() {
    std::vector<Frame> kept;
    std::vector<fs::path> gone;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (k % 2 == 0)
        kept.push_back(std::move(frames_[k]));
      else
        gone.push_back(folder_ / frames_[k].file);
    }
    frames_ = std::move(kept);
    write_list();  // before the files go
    std::error_code ec;
    for (const auto& f : gone)
      fs::remove(f, ec);
  }

 private:
  /// frame_000123.vtp, or what a killed run was writing of it: .frame_000123.vtp.4711.0.part
  static bool is_frame(std::string_view name) {
    const bool part = name.starts_with('.') && name.ends_with(".part");
    if (part) name.remove_prefix(1);
    if (!name.starts_with("frame_")) return false;
    name.remove_prefix(6);
    const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
    const std::string_view rest = name.substr(digits);
    return digits >= 6 && (part ? rest.starts_with(".vtp.") : rest == ".vtp");
  }

  /// What a run that was killed was writing of its list: .run_up_line.pvd.4711.0.part
  void remove_unfinished_lists() const {
    const std::string begin = "." + pvd_.filename().string() + ".";
    std::error_code ec;
    std::vector<fs::path> parts;
    for (const auto& f : fs::directory_iterator(pvd_.parent_path(), ec)) {
      const std::string name = f.path().filename().string();
      if (name.starts_with(begin) && name.ends_with(".part")) parts.push_back(f.path());
    }
    for (const auto& f : parts)
      fs::remove(f, ec);
  }

  void recover(double keep_until) {
    const std::string text = read_text(pvd_);
    constexpr std::string_view open = "<DataSet timestep=\"", mid = "file=\"";
    for (std::size_t p = text.find(open); p != std::string::npos; p = text.find(open, p + 1)) {
      double time = 0;
      std::from_chars(text.data() + p + open.size(), text.data() + text.size(), time);
      const std::size_t a = text.find(mid, p), slash = text.find('/', a),
                        end = text.find('"', slash);
      if (end == std::string::npos || time > keep_until) break;
      frames_.push_back({time, text.substr(slash + 1, end - slash - 1)});
    }
    if (!frames_.empty()) {
      const std::string& f = frames_.back().file;  // frame_000123.vtp
      std::from_chars(f.data() + 6, f.data() + f.size(), next_);
      ++next_;
    }
  }

  std::string line(const Frame& f) const {
    return "<DataSet timestep=\"" + shortest(f.time) + "\" part=\"0\" file=\"" + stem_ + "/" +
           f.file + "\"/>\n";
  }

  // The whole list, in place of an older file in one go.
  void write_list() {
    std::string s(pvd_head);
    // after a kill a frame may be gone that the checkpoint still counts: it is thinned out again at
    // the same frame
    std::error_code ec;
    for (const auto& f : frames_)
      if (fs::exists(folder_ / f.file, ec)) s += line(f);
    length_ = s.size();
    write_atomic(pvd_, s + std::string(pvd_foot));
    file_.open(pvd_);
  }

  std::vector<Frame> frames_;
  std::uint64_t next_ = 0;
  fs::path pvd_, folder_;
  std::string stem_;
  std::uint64_t length_ = 0;  // of the .pvd without its footer
  OverwriteFile file_;
};

/// The files of one set.
class SetFiles {
 public:
  virtual ~SetFiles() = default;
  virtual void append(const PolyData& data, double time) = 0;
  virtual void thin() = 0;
  virtual std::size_t size() const = 0;
  /// What its maker takes to go on with these files.
  virtual void save(OutArchive& out) const = 0;
};

class SeparateFiles final : public SetFiles {
 public:
  /// earlier: of save(); null: files of their own.
  SeparateFiles(const VtkFrameOptions& o, const std::string& stem, PolyDataWriter* writer,
                InArchive* earlier)
      : writer_(writer),
        files_(list_of(o, stem, earlier)) {}
  void append(const PolyData& data, double time) override {
    writer_->write(files_.next_file(), data, time);
    files_.add(time);
  }
  void thin() override { files_.thin(); }
  std::size_t size() const override { return files_.size(); }
  void save(OutArchive& out) const override {
    out.put_count(files_.next());
    out.put_count(files_.size());
    for (const Collection::Frame& f : files_.frames()) {
      out.put(f.time);
      out.put(f.file);
    }
  }

 private:
  static Collection list_of(const VtkFrameOptions& o, const std::string& stem, InArchive* earlier) {
    if (!earlier) return {o.directory, stem, o.keep_until};
    const std::uint64_t next = earlier->count();
    std::vector<Collection::Frame> kept(earlier->count());
    for (Collection::Frame& f : kept) {
      f.time = earlier->number();
      f.file = earlier->text();
    }
    return {o.directory, stem, o.keep_until, std::move(kept), next};
  }
  std::unique_ptr<PolyDataWriter> writer_;
  Collection files_;
};

class OneFile final : public SetFiles {
 public:
  explicit OneFile(PolyDataSeries* series) : series_(series) {}
  void append(const PolyData& data, double time) override { series_->append(data, time); }
  void thin() override { series_->thin(); }
  std::size_t size() const override { return series_->size(); }
  void save(OutArchive& out) const override { series_->save(out); }

 private:
  std::unique_ptr<PolyDataSeries> series_;
};

class VtkFrames final : public FrameWriter {
 public:
  explicit VtkFrames(VtkFrameOptions o)
      : options_(std::move(o)),
        plugin_(Plugin::load(options_.one_file ? "hdf5" : "vtk")) {}

  void begin(const Scene& scene) override {
    open(scene, nullptr);
    offered_ = 0;
    stride_ = 1;
  }

  void save(OutArchive& out) const override {
    out.put_count(offered_);
    out.put_count(stride_);
    for (const auto& s : sets_)
      s.files->save(out);
    for (const auto& s : sets_)
      s.set->save(out);
  }

  void resume(const Scene& scene, InArchive& in) override {
    offered_ = in.count();
    stride_ = in.count();
    open(scene, &in);
    for (const auto& s : sets_)
      s.set->restore(in);
  }

  void frame(const FrameState& state) override {
    if (state.nodes.size() != scene_.nodes.size())
      throw std::logic_error("FrameWriter: not one pose a node");
    if (offered_++ % stride_ != 0) return;
    if (frames_ >= options_.max_frames && options_.max_frames > 1) {
      for (auto& s : sets_)
        s.files->thin();
      frames_ = sets_.empty() ? 0 : sets_.front().files->size();
      const bool on_stride = (offered_ - 1) % (2 * stride_) == 0;
      stride_ *= 2;
      if (!on_stride) return;
    }
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      const auto line = static_cast<std::size_t>(scene_.node_line[i]);
      const Vec3 e = scene_.lines[line].triad.col(0);
      drawn_[i] = meshes::magnified(state.nodes[i], scene_.nodes[i], e, options_.deformation_scale);
      if (scene_.bent(scene_.node_line[i]))
        drawn_[i].phi *=
            options_.deformation_scale;  // it does not spin: its angle is deformation too
    }
    const FramePoses poses{state.nodes, drawn_, &state};
    for (auto& s : sets_) {
      s.set->update(poses);
      s.files->append(s.set->data(), state.time);
    }
    ++frames_;
  }

  void end() override {}
  std::uint64_t frames() const override { return frames_; }

 private:
  struct Set {
    std::unique_ptr<FrameSet> set;
    std::unique_ptr<SetFiles> files;
  };
  /// earlier: what save() of the files of the sets put, in their order; null: new ones.
  std::unique_ptr<SetFiles> make_files(const std::string& stem, InArchive* earlier) const {
    if (!options_.one_file)
      return std::make_unique<SeparateFiles>(
          options_, stem, plugin_.function<VtkMakeWriter>(vtk_make_writer)(options_.compression),
          earlier);
    std::error_code ec;
    fs::create_directories(options_.directory, ec);
    if (ec) io_failure(options_.directory, "cannot make the folder", ec.value());
    return std::make_unique<OneFile>(plugin_.function<Hdf5MakePolyData>(hdf5_make_polydata)(
        options_.directory / (stem + ".vtkhdf"), options_.compression != Compression::none,
        earlier));
  }
  void open(const Scene& scene, InArchive* earlier) {
    sets_.clear();
    scene_ = scene;
    drawn_.resize(scene_.nodes.size());
    const auto add = [&](std::unique_ptr<FrameSet> set) {
      if (options_.deformation_scale != 1.0)
        set->note({"deformation scale", {shortest(options_.deformation_scale)}});
      auto files = make_files(safe_name(options_.name) + "_" + set->name(), earlier);
      sets_.push_back({std::move(set), std::move(files)});
    };
    if (options_.line) add(make_line_set(scene_));
    if (options_.surface) add(make_surface_set(scene_, options_.points_around));
    if (options_.bearings && !scene_.supports.empty()) add(make_support_set(scene_));
    if (options_.orbits && !scene_.trails.empty())
      add(make_trail_set(scene_, options_.trail_points));
    frames_ = sets_.empty() ? 0 : sets_.front().files->size();
  }

  VtkFrameOptions options_;
  const Plugin& plugin_;
  Scene scene_;
  std::vector<Pose> drawn_;
  std::vector<Set> sets_;
  std::uint64_t frames_ = 0, offered_ = 0, stride_ = 1;
};

}  // namespace

void set_content(VtkFrameOptions& o, std::span<const std::string> names) {
  o.line = o.surface = o.bearings = o.orbits = false;
  for (const auto& n : names) {
    if (n == "line")
      o.line = true;
    else if (n == "surface")
      o.surface = true;
    else if (n == "bearings")
      o.bearings = true;
    else if (n == "orbits")
      o.orbits = true;
    else
      throw Error(Exit::deck,
                  Diagnostic{Diagnostic::Severity::error, "E93", "unknown VTK content '" + n + "'",
                             "one of: line, surface, bearings, orbits", Where{}});
  }
}

std::unique_ptr<FrameWriter> make_vtk_frames(VtkFrameOptions options) {
  return std::make_unique<VtkFrames>(std::move(options));
}

FrameSchedule::FrameSchedule(const Options& o, double t_begin, double t_end)
    : t0_(std::max(o.t0, t_begin)),
      t1_(std::min(o.t1, t_end)) {
  WHIRL_EXPECTS(t_begin <= t_end);
  WHIRL_EXPECTS(o.max_frames > 0);
  const int cap = std::max(o.max_frames, 2);
  if (o.every <= 0.0 && o.frames_per_revolution > 0.0) {
    step_angle_ = two_pi / o.frames_per_revolution;
    return;
  }
  if (!(t1_ >= t0_)) return;  // the window lies outside the run
  const double span = t1_ - t0_;
  step_ = o.every > 0.0 ? o.every : span / std::max(o.frames - 1, 1);
  if (step_ > 0.0 && span / step_ > cap - 1) {
    stretch_ = span / step_ / (cap - 1);
    step_ *= stretch_;
  }
  planned_ =
      step_ > 0.0 ? static_cast<std::uint64_t>(std::floor(span / step_ * (1 + 1e-12))) + 1 : 1;
  next_time_ = t0_;
}

void FrameSchedule::set_taken(std::uint64_t n) {
  taken_ = n;
  if (planned_ > 0 && n > 0)
    next_time_ = n < planned_ ? std::min(t0_ + static_cast<double>(n) * step_, t1_) : infinity;
}

double FrameSchedule::next_angle(double phi, double direction) const {
  WHIRL_EXPECTS(by_revolution());
  // A frame at phi itself is behind us: the next multiple, a hair beyond for round-off.
  const double k = phi / step_angle_;
  return direction >= 0.0 ? (std::floor(k + 1e-9) + 1.0) * step_angle_
                          : (std::ceil(k - 1e-9) - 1.0) * step_angle_;
}

void FrameSchedule::advance() {
  ++taken_;
  // Counted, not summed: frame k stands at t0 + k step to the last digit; the last one at the end
  // of the window.
  next_time_ =
      taken_ < planned_ ? std::min(t0_ + static_cast<double>(taken_) * step_, t1_) : infinity;
}

void pose_of_phase(std::span<const Pose> rest, const HarmonicShape& shape, double amplitude,
                   double theta, std::vector<Pose>& out) {
  WHIRL_EXPECTS(shape.u.size() == rest.size() && shape.tilt.size() == rest.size());
  WHIRL_EXPECTS(shape.phi.empty() || shape.phi.size() == rest.size());
  const Complex z = amplitude * std::polar(1.0, theta);
  out.resize(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    out[i].r = rest[i].r + (z * shape.u[i]).real();
    const Vec3 d = rest[i].d + (z * shape.tilt[i]).real();
    out[i].d = d / std::sqrt(d.squaredNorm());
    out[i].phi = rest[i].phi + (shape.phi.empty() ? 0.0 : (z * shape.phi[i]).real());
  }
}

void write_harmonic(FrameWriter& writer, const Scene& scene, const HarmonicShape& shape,
                    double amplitude, int phases) {
  WHIRL_EXPECTS(phases > 0);
  if (shape.u.size() != scene.nodes.size() || shape.tilt.size() != scene.nodes.size())
    throw std::invalid_argument("write_harmonic: one u and one tilt a node");
  std::vector<Pose> rest(scene.nodes.size()), now;
  for (std::size_t i = 0; i < rest.size(); ++i)
    rest[i] = {scene.nodes[i],
               scene.lines[static_cast<std::size_t>(scene.node_line[i])].triad.col(0), 0.0};
  writer.begin(scene);
  for (int k = 0; k < phases; ++k) {
    FrameState s;
    s.time = two_pi * k / phases;
    pose_of_phase(rest, shape, amplitude, s.time, now);
    s.nodes = now;
    writer.frame(s);
  }
  writer.end();
}

}  // namespace whirl::io
