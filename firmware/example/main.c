/* A vbraille device on a Linux pseudo-terminal, without any hardware. Build and run:
     cc -std=gnu99 -I.. main.c -lm -o device && ./device PORT [PATH]
   The slider swings 30 mm about the middle of its travel; or it follows the file PATH, one position in mm a line, one
   line a millisecond, again and again. Stop it with Ctrl+C. -DTRACE prints largest level and number taken, each ms. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/timerfd.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#ifndef VB_ROWS
#define VB_ROWS 6
#define VB_COLUMNS 10
#endif
#ifndef VB_TOP
#define VB_TOP 255
#define VB_FAST 166
#endif
#define VB_RATE 1000
#define VB_ANALOG 0
#define VB_ABOUT "\"name\":\"Pretend\",\"serial\":\"1\",\"pitch_mm\":[1.2,1.4],\"rest\":\"right\"," \
  "\"counts_per_mm\":[200],\"travel_mm\":[220],\"buttons\":2"
#include "vbraille.h"

static int port;
static unsigned top_now;

uint8_t vb_send(const uint8_t *bytes, uint8_t count) {   /* a pseudo-terminal takes a short line whole, or not at all */
  return write(port, bytes, count) == count;
}

void vb_drive(const vb_level *levels) {
  top_now = 0;
  for (int i = 0; i < VB_N; i++) if (levels[i] > top_now) top_now = levels[i];
}

static uint64_t now_us(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000000ull + t.tv_nsec / 1000;
}

static double place_mm(FILE *path, double seconds) {
  static double last = 110;
  if (!path) return 110 + 30 * sin(seconds * 40 / 30);   /* 40 mm/s at most */
  if (fscanf(path, "%lf", &last) != 1) rewind(path);
  return last;
}

int main(int count, char **words) {
  FILE *path = count > 2 ? fopen(words[2], "r") : NULL;
  if (count < 2 || (count > 2 && !path)) { fprintf(stderr, "usage: device LINK [PATH]\n"); return 2; }
  port = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (port < 0 || grantpt(port) || unlockpt(port)) { perror("pseudo-terminal"); return 1; }
  int other = open(ptsname(port), O_RDWR | O_NOCTTY);    /* held open, so that hosts may come and go */
  struct termios mode;
  if (other < 0 || tcgetattr(other, &mode)) { perror("pseudo-terminal"); return 1; }
  cfmakeraw(&mode);
  tcsetattr(other, TCSANOW, &mode);
  unlink(words[1]);
  if (symlink(ptsname(port), words[1])) { perror(words[1]); return 1; }
  int timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  struct itimerspec each = { { 0, 1000000 }, { 0, 1000000 } };
  timerfd_settime(timer, 0, &each, NULL);
  vb_home();                                             /* its places are told from the stop */
  for (uint64_t begin = now_us();;) {
    struct pollfd wait[2] = { { timer, POLLIN, 0 }, { port, POLLIN, 0 } };
    poll(wait, 2, -1);
    uint8_t bytes[4096];
    ssize_t got = wait[1].revents & POLLIN ? read(port, bytes, sizeof bytes) : 0;
    for (ssize_t i = 0; i < got; i++) vb_byte(bytes[i]);
    uint64_t late;                                       /* milliseconds gone by: one tick, however many they are */
    if (read(timer, &late, sizeof late) != sizeof late) continue;
    vb_input seen = { 0 };
    seen.x = (int32_t)lround(200 * place_mm(path, (now_us() - begin) / 1e6));
    vb_tick((uint32_t)now_us(), &seen);
#ifdef TRACE
    printf("%llu %u %u %u\n", (unsigned long long)now_us(), top_now, vb.taken, vb.armed);
    fflush(stdout);
#endif
  }
}
