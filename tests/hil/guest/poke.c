// poke FILE TEXT NAME: writes TEXT into FILE, and prints the time just before it, and NAME, as
// mark() of lib.sh does; a shell's own commands come milliseconds apart.
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const int fd = open(argv[1], O_WRONLY);
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  const long length = (long)strlen(argv[2]);
  if (fd < 0 || write(fd, argv[2], (size_t)length) != length) {
    perror(argv[1]);
    return 1;
  }
  printf("%ld.%09ld %s\n", (long)now.tv_sec, now.tv_nsec, argv[3]);
  return 0;
}
