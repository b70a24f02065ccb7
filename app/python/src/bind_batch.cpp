// Batches: plans, cases as lines of JSON, and the database.
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>

#include "app/batch.h"
#include "app/python/src/bindings.h"

namespace catoptra::python {
namespace py = pybind11;

namespace {

/// How long Ctrl-C may wait for a look.
constexpr std::chrono::milliseconds kGlance{50};

/// Runs the batch on a thread of its own, so that this one (Python runs signal handlers in its main thread
/// only) can look for Ctrl-C. What was computed by then is stored before the exception leaves. Without the
/// interpreter's lock.
app::BatchProgress run_interruptibly(const app::BatchPlan& plan, app::BatchStore& store, std::size_t jobs,
                                     const std::function<void(std::size_t, std::size_t)>& progress) {
  std::atomic<bool> stop = false;
  app::BatchRunOptions options;
  options.jobs = jobs;
  options.stop = &stop;
  if (progress)
    options.progress = [&](const app::BatchProgress& p) { progress(p.done + p.failed, p.wanted); };
  auto running = std::async(std::launch::async, [&] { return app::run_batch(plan, store, options); });
  while (running.wait_for(kGlance) != std::future_status::ready) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() == 0) continue;
    stop = true;
    const py::error_already_set interrupt;  // takes the exception, usually KeyboardInterrupt
    {
      const py::gil_scoped_release release;
      running.wait();
    }
    throw interrupt;
  }
  return running.get();
}

}  // namespace

void bind_batch(py::module_& module) {
  py::class_<app::BatchPlan>(module, "BatchPlan", "A plan with its cases, each once, in the plan's order.")
      .def_readonly("file", &app::BatchPlan::file)
      .def_readonly("repeated", &app::BatchPlan::repeated)
      .def("__len__", [](const app::BatchPlan& plan) { return plan.cases.size(); });
  module.def(
      "read_batch_plan",
      [](const std::filesystem::path& file) {
        const py::gil_scoped_release release;
        return app::read_batch_plan(file);
      },
      py::arg("file"), "Reads a plan (TOML) and hashes every lens file that it names.");
  module.def(
      "evaluate_batch_case",
      [](const std::string& line) {
        const py::gil_scoped_release release;
        return app::evaluate_case(line);
      },
      py::arg("line"), "Computes one case: from its line of JSON to the result's. A pure function.");
  py::class_<app::BatchStore>(module, "BatchStore",
                              "The database of a batch, open for writing by this process alone.")
      .def(
          py::init([](const std::filesystem::path& file) { return std::make_unique<app::BatchStore>(file); }),
          py::arg("file"))
      .def(
          "add",
          [](app::BatchStore& store, const app::BatchPlan& plan) {
            const py::gil_scoped_release release;
            return store.add(plan);
          },
          py::arg("plan"), "Enters the cases that are not there yet; returns how many.")
      .def(
          "pending",
          [](app::BatchStore& store, const app::BatchPlan& plan) {
            const py::gil_scoped_release release;
            std::vector<std::string> lines;
            for (const app::BatchCase& batch_case : store.pending(plan))
              lines.push_back(app::to_json(batch_case));
            return lines;
          },
          py::arg("plan"), "The plan's cases without result or error yet, as lines of JSON.")
      .def(
          "put",
          [](app::BatchStore& store, const std::string& line) {
            const py::gil_scoped_release release;
            store.put(app::result_from_json(line));
          },
          py::arg("line"), "Stores a result in one transaction; one that is there already stays.");
  module.def(
      "run_batch_here",
      [](const app::BatchPlan& plan, app::BatchStore& store, std::size_t jobs,
         const std::function<void(std::size_t, std::size_t)>& progress) {
        const py::gil_scoped_release release;
        const app::BatchProgress ran = run_interruptibly(plan, store, jobs, progress);
        return std::pair(ran.done, ran.failed);
      },
      py::arg("plan"), py::arg("store"), py::arg("jobs") = 0, py::arg("progress") = py::none(),
      "Computes what is pending on this machine's cores; returns how many were done and how many failed. "
      "Ctrl-C ends it once the cases in hand are stored.");
}

}  // namespace catoptra::python
