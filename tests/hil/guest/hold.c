// hold THREAD NAME: stops one thread of a process, as a debugger does, until the process ends; prints
// the time just before it, and NAME, as mark() of lib.sh does. The others go on, and the process can be
// killed: unlike a thread that is starved of its processor, the held one does not delay its end.
#include <stdio.h>
#include <stdlib.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const pid_t thread = (pid_t)atoi(argv[1]);
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (ptrace(PTRACE_SEIZE, thread, NULL, NULL) != 0 || ptrace(PTRACE_INTERRUPT, thread, NULL, NULL) != 0) {
    perror("hold");
    return 1;
  }
  printf("%ld.%09ld %s\n", (long)now.tv_sec, now.tv_nsec, argv[2]);
  fflush(stdout);
  int status = 0;
  do {
    if (waitpid(thread, &status, __WALL) != thread) return 1;
  } while (!WIFEXITED(status) && !WIFSIGNALED(status));
  return 0;
}
