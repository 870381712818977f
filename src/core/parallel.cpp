#include "parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <memory>

namespace colod {
namespace {

std::unique_ptr<tbb::global_control>& control() {
  static std::unique_ptr<tbb::global_control> c;
  return c;
}

}  // namespace

void parallel_ranges(std::size_t n, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  if (thread_count() == 1) {
    if (n > 0) body(0, n);
    return;
  }
  // Isolated: a thread that waits for an inner loop must not start another building of an outer
  // one, which would keep more of them in memory than there are threads. A context of its own: an
  // exception elsewhere in an outer loop would end this one early without a word, and its caller
  // would take what it has not done for done.
  tbb::this_task_arena::isolate([&] {
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, grain),
        [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); }, context);
  });
}

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, std::size_t grain) {
  parallel_ranges(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

void limit_threads(int threads) {
  control().reset();
  if (threads > 0)
    control() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      threads);
}

void in_threads(int threads, const std::function<void()>& body) {
  if (threads <= 0) return body();
  tbb::task_arena(threads).execute(body);
}

int thread_count() {
  return std::min(static_cast<int>(tbb::global_control::active_value(
                      tbb::global_control::max_allowed_parallelism)),
                  tbb::this_task_arena::max_concurrency());
}

}  // namespace colod
