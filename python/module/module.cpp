/// The module behind the Python package: scenes, simulations and parts, as few types as can be.
///
/// What users see is written in Python (python/noether); nothing here names a part.

#include "cli/program.hpp"
#include "numbers/error.hpp"
#include "python/module/scenes.hpp"
#include "study/suite.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <exception>
#include <string>
#include <vector>

namespace nb = nanobind;

namespace noether::python {

namespace {

/// Errors of noether as Python's: each below `Error`, which is a ValueError; files that cannot be read are OSErrors.
void bind_errors(nb::module_& m) {
  static const nb::exception<Error> error(m, "Error", PyExc_ValueError);
  static PyObject* bases = PyTuple_Pack(2, error.ptr(), PyExc_OSError);
  static PyObject* file_error = PyErr_NewException("noether._core.FileError", bases, nullptr);
  m.attr("FileError") = nb::borrow(file_error);
  nb::register_exception_translator([](const std::exception_ptr& thrown, void* /*payload*/) {
    try {
      std::rethrow_exception(thrown);
    } catch (const FileError& wrong) {
      PyErr_SetString(file_error, wrong.what());
    } catch (const Error& wrong) {
      PyErr_SetString(error.ptr(), wrong.what());
    }
  });
}

/// The program of these words, the first its name. A wheel has no other: a second copy of everything would double it.
int run_program(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return program(static_cast<int>(words.size()), arguments.data());
}

}  // namespace

}  // namespace noether::python

NB_MODULE(_core, m) {
  using namespace noether::python;
  bind_errors(m);
  m.def("suite_folder", [] { return noether::suite_folder().string(); });
  m.def("program", &run_program, nb::arg("words"), nb::call_guard<nb::gil_scoped_release>());
  bind_parts(m);
  bind_elements(m);
  bind_scenes(m);
  bind_simulations(m);
}
