// How often this test program has taken memory from the heap. Test support.
#pragma once

namespace gannet::search {
long heap_count();
}  // namespace gannet::search
