// How a batch scales: cases per second on all cores over those on one, per core, in alternating runs.
// Usage: bench_batch [lenses] [rounds]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <vector>

#include "app/batch.h"

namespace {

using namespace catoptra;

/// Lenses of 50 mm as worn in six positions, each measured at 49 directions: what a batch usually is.
app::BatchPlan plan_of(int lenses) {
  return app::read_batch_plan_text(
      "[[prescriptions]]\nsample = { count = " + std::to_string(lenses) +
          ", seed = 1 }\n"
          "sph = { from = -6, to = 3 }\ncyl = { from = -2, to = 0 }\n"
          "axis = { from = 0, to = 180 }\ndiameter = 50\nmaterial = \"CR-39\"\n"
          "[[poses]]\nmode = \"as-worn\"\npanto_deg = [0, 6, 12]\nwrap_deg = [0, 5]\n"
          "[[gaze]]\nmax_deg = 32\nstep_deg = 8\n",
      "bench", ".");
}

double cases_per_second(const app::BatchPlan& plan, std::size_t jobs) {
  const auto file = std::filesystem::temp_directory_path() / "catoptra_bench_batch.sqlite";
  double rate = 0;
  {
    app::BatchStore store(file);
    app::BatchRunOptions options;
    options.jobs = jobs;
    const app::BatchProgress ran = app::run_batch(plan, store, options);
    rate = double(ran.done) / ran.seconds;
  }
  std::filesystem::remove(file);
  return rate;
}

}  // namespace

int main(int argc, char** argv) {
  const int lenses = argc > 1 ? std::atoi(argv[1]) : 60, rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  const app::BatchPlan plan = plan_of(lenses);
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const double one = cases_per_second(plan, 1), all = cases_per_second(plan, cores);
    ratios.push_back(all / one);
    std::printf(
        "%zu cases of %d lenses: %.0f a second on 1 core, %.0f on %zu: %.2f times, %.0f %% per core\n",
        plan.cases.size(), lenses, one, all, cores, all / one, 100 * all / one / double(cores));
  }
  std::sort(ratios.begin(), ratios.end());
  const double median = ratios[ratios.size() / 2];
  std::printf("median %.2f times, %.0f %% per core\n", median, 100 * median / double(cores));
  return 0;
}
