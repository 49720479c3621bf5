/* A controller at a pseudo-terminal, or at a socket of this computer if PLACE is a port, that measures how long after
   each of its STATEs a FRAME comes. It prints them all, in ns, once SECONDS are over: ./device PLACE SECONDS */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/timerfd.h>
#include <termios.h>
#include <time.h>
#include <fcntl.h>
#include <unistd.h>
#define VB_ROWS 6
#define VB_COLUMNS 10
#define VB_TOP 1023
#define VB_FAST 700
#define VB_RATE 1000
#define VB_ANALOG 0
#define VB_ABOUT "\"name\":\"timed\",\"pitch_mm\":[1.2,1.8],\"rest\":\"right\",\"counts_per_mm\":[200],\"travel_mm\":[300]"
#include "vbraille.h"

static int port, waiting;
static uint64_t sent_ns;
static uint64_t now_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000000000ull + t.tv_nsec;
}
uint8_t vb_send(const uint8_t *bytes, uint8_t count) {
  sent_ns = now_ns();
  waiting = 1;
  return write(port, bytes, count) == count;
}
void vb_drive(const vb_level *levels) { (void)levels; }

static int terminal(const char *link) {
  int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (master < 0 || grantpt(master) || unlockpt(master)) return -1;
  int other = open(ptsname(master), O_RDWR | O_NOCTTY);
  struct termios mode;
  tcgetattr(other, &mode);
  cfmakeraw(&mode);
  tcsetattr(other, TCSANOW, &mode);
  unlink(link);
  return symlink(ptsname(master), link) ? -1 : master;
}
static int connection(int number) {
  struct sockaddr_in at = { .sin_family = AF_INET, .sin_port = htons((uint16_t)number), .sin_addr.s_addr = htonl(INADDR_LOOPBACK) };
  int yes = 1, listening = socket(AF_INET, SOCK_STREAM, 0);
  setsockopt(listening, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (bind(listening, (struct sockaddr *)&at, sizeof at) || listen(listening, 1)) return -1;
  int link = accept4(listening, NULL, NULL, SOCK_NONBLOCK);
  setsockopt(link, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return link;
}

int main(int count, char **words) {
  if (count < 3) return 2;
  port = atoi(words[1]) ? connection(atoi(words[1])) : terminal(words[1]);
  if (port < 0) return 1;
  int timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  struct itimerspec each = { { 0, 1000000 }, { 0, 1000000 } };
  timerfd_settime(timer, 0, &each, NULL);
  vb_home();
  uint64_t live_ns = 0, most_ns = (uint64_t)(atof(words[2]) * 1e9);
  while (!live_ns || now_ns() - live_ns < most_ns) {
    struct pollfd wait[2] = { { timer, POLLIN, 0 }, { port, POLLIN, 0 } };
    poll(wait, 2, -1);
    uint8_t bytes[4096];
    ssize_t got = wait[1].revents & POLLIN ? read(port, bytes, sizeof bytes) : 0;
    uint16_t before = vb.taken;
    for (ssize_t i = 0; i < got; i++) vb_byte(bytes[i]);
    if (vb.taken != before && vb.armed) {
      if (!live_ns) live_ns = now_ns();
      if (waiting) printf("%llu\n", (unsigned long long)(now_ns() - sent_ns));
      waiting = 0;
    }
    uint64_t late;
    if (read(timer, &late, sizeof late) != sizeof late) continue;
    vb_input seen;
    memset(&seen, 0, sizeof seen);
    double s = now_ns() / 1e9;
    seen.x = (int32_t)(200 * (110 + 70 * ((s - (long)s) < 0.5 ? (s - (long)s) : 1 - (s - (long)s))));
    vb_tick((uint32_t)(now_ns() / 1000), &seen);
  }
  return 0;
}
