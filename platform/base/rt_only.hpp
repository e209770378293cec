// Included last in the sources of real-time loops: from here to the end of the file the names
// below do not compile. They take locks or memory, sleep, or write text. Headers before it may
// use them, so that this is the first net; tests/rt with its malloc trap is the second. Any thread.
#pragma once

// Placement new is poisoned with new; a loop's memory is taken by its wiring.
#pragma GCC poison new malloc calloc realloc free strdup
#pragma GCC poison make_unique make_shared shared_ptr
#pragma GCC poison printf fprintf snprintf sprintf puts fputs fwrite cout cerr ostringstream
#pragma GCC poison fopen fclose ofstream ifstream
#pragma GCC poison mutex lock_guard unique_lock condition_variable
#pragma GCC poison sleep usleep nanosleep sleep_for sleep_until throw
