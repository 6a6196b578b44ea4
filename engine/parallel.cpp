#include "engine/parallel.hpp"

#include "engine/error.hpp"

#include <fmt/format.h>

namespace noether {

#ifdef _OPENMP
namespace {
int threads_in_use = omp_get_max_threads();
}

int thread_count() { return threads_in_use; }

void set_thread_count(int threads) {
  if (threads < 1) throw Error(fmt::format("{} threads were asked for; at least 1 is needed", threads));
  threads_in_use = threads;
}
#else
int thread_count() { return 1; }

void set_thread_count(int threads) {
  if (threads < 1) throw Error(fmt::format("{} threads were asked for; at least 1 is needed", threads));
}
#endif

}  // namespace noether
