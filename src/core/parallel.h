// The only door to TBB: loops whose iterations write to their own slots, so that results do not
// depend on threads.
#pragma once

#include <cstddef>
#include <functional>

namespace colod {

/// Runs body(i) for i in [0, n), in any order, on the threads allowed by limit_threads. Nested
/// calls share the same pool. The first exception of a body is rethrown; loops within bodies that
/// still run are run to their ends. `grain`: iterations a task takes at least.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body,
                  std::size_t grain = 1);

/// The same over ranges: body(begin, end). Cheaper for tiny iterations.
void parallel_ranges(std::size_t n, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// At most `threads` threads from now on, in the whole process; 0 = all cores. Called once, by the
/// command line or a test.
void limit_threads(int threads);

/// Runs `body` so that its loops take at most `threads` threads, 0 = no limit of its own. Two
/// callers may have two limits at the same time.
void in_threads(int threads, const std::function<void()>& body);

/// How many threads parallel_for may use here.
int thread_count();

}  // namespace colod
