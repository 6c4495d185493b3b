// The extension module: meshes, calls of sub-commands, errors. What users see is made of it in package/*.py.
#include "preproc/command/call.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/python/mesh_arrays.hpp"
#include "preproc/python/running_call.hpp"

#include <scan2fea/version.hpp>

#include <pybind11/stl.h>
#include <utility>

namespace scan2fea::python {
namespace {

namespace py = pybind11;

const char* class_of(const Error& error) {
  if (dynamic_cast<const OutOfTime*>(&error) != nullptr) return "OutOfTime";
  if (dynamic_cast<const WrongUsage*>(&error) != nullptr) return "WrongUsage";
  if (dynamic_cast<const InvalidInput*>(&error) != nullptr) return "InvalidInput";
  if (dynamic_cast<const NotMeshable*>(&error) != nullptr) return "NotMeshable";
  if (dynamic_cast<const MeshingFailed*>(&error) != nullptr) return "MeshingFailed";
  if (dynamic_cast<const IoError*>(&error) != nullptr) return "IoError";
  if (dynamic_cast<const Cancelled*>(&error) != nullptr) return "Cancelled";
  return "Error";
}

// As Python's, with its parts.
void raise(const Error& error) {
  const py::object type = py::module_::import("scan2fea._errors").attr(class_of(error));
  const ErrorParts& parts = error.parts();
  const py::object at =
      parts.at ? py::object(py::make_tuple(parts.at->x(), parts.at->y(), parts.at->z())) : py::object(py::none());
  const py::object instance = type(text_of(error.what()), text_of(parts.what), text_of(parts.where),
                                   text_of(parts.value), text_of(parts.limit), text_of(parts.advice), at);
  PyErr_SetObject(type.ptr(), instance.ptr());
}

py::list texts(const std::vector<std::string>& lines) {
  py::list list;
  for (const std::string& line : lines) list.append(text_of(line));
  return list;
}

std::vector<command::SharedMesh> shared(const py::list& meshes) {
  std::vector<command::SharedMesh> list;
  for (const py::handle mesh : meshes)
    list.push_back(mesh.is_none() ? command::SharedMesh() : mesh.cast<const PythonMesh&>().mesh);
  return list;
}

using KeywordValues = std::vector<std::pair<std::string, std::vector<std::vector<std::string>>>>;

// (exit code, figures as JSON, mesh or None, warnings, failed gates)
py::tuple call(const std::string& command, const KeywordValues& values, const py::list& inputs,
               const py::list& references, const py::object& progress) {
  std::vector<command::Keyword> keywords;
  for (const auto& [name, given] : values) keywords.push_back({name, given});
  const auto running = std::make_shared<RunningCall>();
  running->caller.inputs = shared(inputs);
  running->caller.references = shared(references);
  std::string figures;
  running->work = [command, keywords = std::move(keywords)](RunningCall& self) {
    self.exit_code = command::call(command, keywords, self.caller);
  };
  run_while_python_waits(running, progress);
  if (!running->caller.figures.is_null())
    figures = running->caller.figures.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const command::SharedMesh& made = running->caller.made;
  return py::make_tuple(running->exit_code, figures, made ? py::cast(PythonMesh{made}) : py::object(py::none()),
                        texts(running->warnings), texts(running->failures));
}

// (mesh, warnings)
py::tuple read(const std::string& file, const std::string& unit) {
  const auto running = std::make_shared<RunningCall>();
  running->work = [file, unit](RunningCall& self) { self.caller.made = command::read_into_memory(file, unit); };
  run_while_python_waits(running, py::none());
  return py::make_tuple(PythonMesh{running->caller.made}, texts(running->warnings));
}

py::list options(const std::string& command) {
  py::list list;
  for (const command::CallOption& option : command::options_of_call(command)) {
    py::dict entry;
    entry["name"] = option.name;
    entry["value"] = option.value;
    entry["text"] = option.text;
    entry["default"] = option.default_value;
    entry["group"] = option.group;
    entry["choices"] = option.choices;
    entry["is_repeatable"] = option.is_repeatable;
    entry["at_a_time"] = option.at_a_time;
    list.append(entry);
  }
  return list;
}

}  // namespace

PYBIND11_MODULE(_scan2fea, module) {
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& error) {
      raise(error);
    }
  });
  py::class_<PythonMesh>(module, "Mesh")
      .def_property_readonly("kind", &kind_of)
      .def_property_readonly("order", &order_of)
      .def_property_readonly("unit", &unit_of)
      .def_property_readonly("name", [](const PythonMesh& mesh) { return text_of(mesh.mesh->name.string()); })
      .def_property_readonly("points", &points_of)
      .def_property_readonly("cells", &cells_of)
      .def_property_readonly("triangles", &triangles_of)
      .def_property_readonly("node_sets", &node_sets_of)
      .def_property_readonly("face_sets", &face_sets_of)
      .def_property_readonly("element_sets", &element_sets_of);
  module.def("mesh_of_arrays", &mesh_of_arrays);
  module.def("call", &call);
  module.def("read", &read);
  module.def("options", &options);
  module.def("wait_for_ending", &wait_for_ending);
  module.attr("version") = library_version;
}

}  // namespace scan2fea::python
