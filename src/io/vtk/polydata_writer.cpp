// The only file that sees VTK: .vtp by VTK's own XML writer, appended raw data, LZ4.
#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/polydata.hpp>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <SMP/Common/vtkSMPToolsAPI.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTypeInt32Array.h>
#include <vtkXMLPolyDataWriter.h>
#include <optional>

namespace whirl::io {
namespace {

// The arrays are lent to VTK, not copied: they live until the file is written.
template <class VtkArray, class T>
vtkSmartPointer<vtkDataArray> lend(const std::vector<T>& v, int components, const char* name) {
  auto a = vtkSmartPointer<VtkArray>::New();
  a->SetName(name);
  a->SetNumberOfComponents(components);
  a->SetArray(const_cast<T*>(v.data()), static_cast<vtkIdType>(v.size()), 1);
  return a;
}

vtkSmartPointer<vtkDataArray> lend(const PolyData::Array& a) {
  struct Visitor {
    const PolyData::Array& a;
    vtkSmartPointer<vtkDataArray> operator()(const std::vector<float>& v) const {
      return lend<vtkFloatArray>(v, a.components, a.name.c_str());
    }
    vtkSmartPointer<vtkDataArray> operator()(const std::vector<std::int32_t>& v) const {
      return lend<vtkIntArray>(v, a.components, a.name.c_str());
    }
  };
  return std::visit(Visitor{a}, a.values);
}

vtkSmartPointer<vtkCellArray> copy(const PolyData::Cells& c) {
  vtkNew<vtkTypeInt32Array> offsets, points;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(c.offset.size()));
  points->SetNumberOfValues(static_cast<vtkIdType>(c.point.size()));
  std::copy(c.offset.begin(), c.offset.end(), offsets->GetPointer(0));
  std::copy(c.point.begin(), c.point.end(), points->GetPointer(0));
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, points);
  return cells;
}

vtkSmartPointer<vtkStringArray> copy(const PolyData::Names& n) {
  auto a = vtkSmartPointer<vtkStringArray>::New();
  a->SetName(n.name.c_str());
  for (const std::string& value : n.values)
    a->InsertNextValue(value);
  return a;
}

class Writer final : public PolyDataWriter {
 public:
  Writer() {
    vtkObject::GlobalWarningDisplayOff();  // failures come back as an error code
    // threads for arrays of a few thousand numbers cost more than the numbers
    // (and the backend of std::thread, which asks the system for the number of processors in every
    // look at an array even while it does not work, is told once)
    auto& smp = vtk::detail::smp::vtkSMPToolsAPI::GetInstance();
    smp.SetBackend("STDThread");
    smp.Initialize(1);
    smp.SetBackend("Sequential");
    writer_->SetDataModeToAppended();
    writer_->EncodeAppendedDataOff();
    writer_->WriteToOutputStringOn();   // into a file it writes and seeks some 260 times
    writer_->SetCompressorTypeToLZ4();  // a third of the time of zlib, for 1.7 times the size
    time_->SetName("TimeValue");
    time_->SetNumberOfValues(1);
  }

  void write(const std::filesystem::path& file, const PolyData& data, double time) override {
    if (topology_ != data.topology) {
      vertices_ = copy(data.vertices);
      lines_ = copy(data.lines);
      polygons_ = copy(data.polygons);
      names_.clear();
      for (const PolyData::Names& n : data.names)
        names_.push_back(copy(n));
      topology_ = data.topology;
    }
    vtkNew<vtkPolyData> poly;
    vtkNew<vtkPoints> points;
    points->SetData(lend<vtkFloatArray>(data.points, 3, "Points"));
    poly->SetPoints(points);
    if (data.vertices.size()) poly->SetVerts(vertices_);
    if (data.lines.size()) poly->SetLines(lines_);
    if (data.polygons.size()) poly->SetPolys(polygons_);
    for (const auto& a : data.point_data) {
      if (a.name == data.normals)
        poly->GetPointData()->SetNormals(lend(a));
      else
        poly->GetPointData()->AddArray(lend(a));
    }
    for (const auto& a : data.cell_data)
      poly->GetCellData()->AddArray(lend(a));
    time_->SetValue(0, time);
    time_->Modified();  // or the range in the file stays that of the first frame
    poly->GetFieldData()->AddArray(time_);
    for (const auto& n : names_)
      poly->GetFieldData()->AddArray(n);
    writer_->SetInputData(poly);
    const bool ok = writer_->Write() == 1 && writer_->GetErrorCode() == vtkErrorCode::NoError;
    const auto code = writer_->GetErrorCode();
    writer_->SetInputData(nullptr);
    if (!ok)
      io_failure(file, std::string("VTK cannot write (") +
                           vtkErrorCode::GetStringFromErrorCode(code) + ")");
    AppendFile out(0);  // of a name of its own until it is whole
    out.create(file, writer_->GetOutputString());
    out.close();
  }

 private:
  vtkNew<vtkXMLPolyDataWriter> writer_;
  vtkNew<vtkDoubleArray> time_;
  vtkSmartPointer<vtkCellArray> vertices_, lines_, polygons_;
  std::vector<vtkSmartPointer<vtkStringArray>> names_;
  std::optional<std::uint64_t> topology_;
};

}  // namespace
}  // namespace whirl::io

WHIRL_DEFINE_PLUGIN
WHIRL_PLUGIN_EXPORT whirl::io::PolyDataWriter* whirl_vtk_make_writer() {
  return new whirl::io::Writer;
}
