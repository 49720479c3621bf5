/* vbraille.h: the controller's side of protocol 3 (docs/wire-protocol.md). No malloc, no float; C99 or C++11.
   Define, as plain numbers, before you include it:
     VB_ROWS, VB_COLUMNS   actuators: 1 to 255 of them, row by row, the far row first, the left column first
     VB_TOP, VB_FAST       level of a full swing, 1 to 1023 (0 is rest); levels that one may go in a millisecond
     VB_RATE, VB_ANALOG    STATEs a second, a divisor of 1000 from 50 on; analog inputs, 0 to 8
     VB_ABOUT              the rest of INFO, JSON without braces: "\"name\":\"My VBD\",\"counts_per_mm\":[200],..."
   You write two functions:
     vb_send    hands bytes to the line, all of them or none, and never waits; returns 1 if it took them
     vb_drive   sets the actuators to these levels
   You call these, none of which may interrupt another: call them all from the main loop.
     vb_byte    for each byte that came from the host
     vb_tick    once a millisecond; a late tick is not caught up: never call it twice to make up for one
     vb_say     to tell something: code 1 is a fault (the array rests until the next HELLO), 0 a note
     vb_home    if the encoders count from the stop by themselves (absolute ones, or after homing): no ZERO is needed
   Only vb_tick sends and drives. If your loop can hang, let the chip's watchdog reset it, and rest in its start-up. */
#ifndef VBRAILLE_H
#define VBRAILLE_H
#include <stdint.h>
#include <string.h>

#if !defined VB_ROWS || !defined VB_COLUMNS || !defined VB_TOP || !defined VB_FAST || !defined VB_RATE \
  || !defined VB_ANALOG || !defined VB_ABOUT
#error "define VB_ROWS, VB_COLUMNS, VB_TOP, VB_FAST, VB_RATE, VB_ANALOG and VB_ABOUT before vbraille.h"
#endif
#define VB_N (VB_ROWS * VB_COLUMNS)
#define VB_SLOW ((VB_TOP + 19) / 20)                     /* resting takes 20 ms from a full swing */
#if VB_ROWS < 1 || VB_COLUMNS < 1 || VB_ROWS > 255 || VB_COLUMNS > 255 || VB_N > 255
#error "VB_ROWS * VB_COLUMNS is 1 to 255"
#elif VB_TOP < 1 || VB_TOP > 1023 || VB_FAST < VB_SLOW || VB_FAST > VB_TOP
#error "VB_TOP is 1 to 1023; VB_FAST is VB_TOP / 20, rounded up, to VB_TOP"
#elif VB_RATE < 50 || VB_RATE > 1000 || 1000 % VB_RATE || VB_ANALOG < 0 || VB_ANALOG > 8
#error "VB_RATE divides 1000 and is 50 or more; VB_ANALOG is 0 to 8"
#endif
#define VB_TEXT_(number) #number
#define VB_TEXT(number) VB_TEXT_(number)
#define VB_INFO_TEXT "{\"rows\":" VB_TEXT(VB_ROWS) ",\"columns\":" VB_TEXT(VB_COLUMNS) ",\"top\":" VB_TEXT(VB_TOP) \
  ",\"fast\":" VB_TEXT(VB_FAST) ",\"rate\":" VB_TEXT(VB_RATE) "," VB_ABOUT "}"
#define VB_INFO_SIZE (sizeof VB_INFO_TEXT - 1)
#define VB_PIECES ((VB_INFO_SIZE + 47) / 48)
typedef char vb_about_is_at_most_32_pieces_of_48_bytes[VB_PIECES <= 32 ? 1 : -1];
#ifdef __AVR__                                           /* there, constants take RAM unless they are told not to */
#include <avr/pgmspace.h>
static const char vb_info[] PROGMEM = VB_INFO_TEXT;
#define VB_COPY memcpy_P
#else
static const char vb_info[] = VB_INFO_TEXT;
#define VB_COPY memcpy
#endif
#if VB_TOP > 255                                         /* levels of 10 bits, packed: 4 in 5 bytes */
typedef uint16_t vb_level;
#define VB_LEVEL_BYTES ((VB_N * 10 + 7) / 8)
#define VB_LEVEL(p, i) (((p)[(i) * 10 / 8] | (p)[(i) * 10 / 8 + 1] * 256u) >> (i) * 10 % 8 & 1023)
#else
typedef uint8_t vb_level;
#define VB_LEVEL_BYTES VB_N
#define VB_LEVEL(p, i) ((p)[i])
#endif

typedef struct {
  int32_t x, y, turn;                                    /* counts of the encoders; they must never wrap */
  uint8_t buttons, knobs[4];                             /* button k is bit k, 1 while pressed */
  int16_t analog[VB_ANALOG + 1];                         /* the last one is not sent */
} vb_input;

uint8_t vb_send(const uint8_t *bytes, uint8_t count);
void vb_drive(const vb_level *levels);

enum { VB_HELLO = 0x01, VB_FRAME = 0x02, VB_ZERO = 0x03, VB_INFO = 0x81, VB_STATE = 0x82, VB_SAY = 0x83 };
enum { VB_PLACED = 1, VB_WAITING = 2, VB_FAULT = 4 };    /* flags of a STATE */

static struct {                                          /* all zero is how it starts: not greeted, and waiting */
  uint8_t line[3 + VB_LEVEL_BYTES + 4], code, left;      /* a line as it comes in: its COBS is taken off at once */
  uint16_t length;
  vb_level level[VB_N], goal[VB_N];
  uint8_t greeted, ready, resting, armed, faulty, placed, age, until_state, piece, pieces, say_code, trips, dropped;
  uint16_t taken, number;
  uint32_t now, taken_at;
  vb_input zero, seen;                                   /* the encoders at ZERO, and at the last tick */
  const char *say;
} vb;

static inline uint32_t vb_crc(const uint8_t *p, uint16_t count) {        /* the CRC-32 of zlib, four bits at a time */
  static const uint32_t table[16] = {
    0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
    0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C };
  uint32_t crc = 0xFFFFFFFF;
  for (; count--; p++) {
    crc = crc >> 4 ^ table[(crc ^ *p) & 15];
    crc = crc >> 4 ^ table[(crc ^ *p >> 4) & 15];
  }
  return ~crc;
}
static inline uint8_t *vb_put(uint8_t *p, uint32_t value, uint8_t bytes) {
  for (; bytes--; value >>= 8) *p++ = (uint8_t)value;
  return p;
}
static inline uint8_t vb_line(uint8_t *body, uint8_t *end) {             /* body has room for the CRC */
  uint8_t out[64], *code = out, *o = out + 1;
  end = vb_put(end, vb_crc(body, (uint16_t)(end - body)), 4);
  for (; body < end; body++)
    if (*body) *o++ = *body;
    else { *code = (uint8_t)(o - code); code = o++; }
  *code = (uint8_t)(o - code);
  *o++ = 0;
  return vb_send(out, (uint8_t)(o - out));
}
static inline void vb_rest(uint8_t ready) {              /* down to 0 in 20 ms; if not ready, it then waits for REST */
  memset(vb.goal, 0, sizeof vb.goal);
  vb.resting = 1, vb.ready = ready, vb.armed = 0;
}
static inline void vb_say(uint8_t code, const char *text) {              /* of a fault that lasts, the first is said */
  if (code && vb.faulty) return;
  vb.say_code = code, vb.say = text;
  if (code) { vb.faulty = 1; vb_rest(0); }
}
static inline void vb_home(void) { memset(&vb.zero, 0, sizeof vb.zero); vb.placed = 1; }
static inline uint8_t vb_frame(const uint8_t *levels) {  /* all levels are taken, or none */
  for (uint16_t i = 0; i < VB_N; i++) { uint16_t level = VB_LEVEL(levels, i); if (level > VB_TOP) return 0; }
  for (uint16_t i = 0; i < VB_N; i++) vb.goal[i] = (vb_level)VB_LEVEL(levels, i);
  vb.armed = 1, vb.age = 0, vb.taken_at = vb.now;
  return 1;
}
static inline uint8_t vb_obey(const uint8_t *body, uint16_t size) {      /* 1 if it was obeyed */
  uint16_t number = size >= 3 ? (uint16_t)(body[1] | body[2] * 256u) : 0;
  if (body[0] == VB_HELLO && size == 2) {
    vb.greeted = body[1] == 3, vb.faulty = 0;
    if (vb.say_code) vb.say = 0;                         /* a fault that lasts is said anew */
    vb.piece = 0, vb.pieces = VB_PIECES;                 /* answered whatever the version, piece by piece */
    vb_rest(0);
    return 1;
  }
  if (!vb.greeted) return 0;
  if (body[0] == VB_ZERO && size == 1) { vb.zero = vb.seen; vb.placed = 1; return 1; }
  if (body[0] != VB_FRAME || vb.faulty) return 0;
  if (size == 3) { vb_rest(1); vb.taken = number; return 1; }            /* REST: a FRAME without levels */
  if (size != 3 + VB_LEVEL_BYTES || !vb.ready || vb.resting) return 0;
  if ((uint16_t)(number - vb.taken - 1) >= 32767 || !vb_frame(body + 3)) return 0;
  vb.taken = number;
  return 1;
}
static inline void vb_store(uint8_t b) {
  if (vb.length < sizeof vb.line) vb.line[vb.length] = b;
  if (vb.length <= sizeof vb.line) vb.length++;          /* one more than there is room for: too long */
}
static inline void vb_byte(uint8_t b) {
  if (b && vb.left) { vb_store(b); vb.left--; return; }
  if (b) {                                               /* a code of COBS: how far it is to the next */
    if (vb.code && vb.code < 255) vb_store(0);
    vb.code = b, vb.left = b - 1;
    return;
  }
  if (vb.code && (vb.left || vb.length < 5 || vb.length > sizeof vb.line || vb_crc(vb.line, vb.length) != 0x2144DF1C
                  || !vb_obey(vb.line, vb.length - 4))) vb.dropped++;
  vb.length = vb.code = vb.left = 0;
}
static inline void vb_speak(void) {                      /* one line a tick: a piece of INFO, else SAY, else a STATE */
  uint8_t body[60] = { 0 }, *p;
  if (vb.until_state) vb.until_state--;
  if (vb.pieces) {
    uint16_t at = vb.piece * 48, size = VB_INFO_SIZE - at < 48 ? (uint16_t)(VB_INFO_SIZE - at) : 48;
    p = vb_put(body, VB_INFO | 3 << 8 | (uint32_t)vb.piece << 16 | (uint32_t)vb.pieces << 24, 4);
    VB_COPY(p, vb_info + at, size);
    if (vb_line(body, p + size) && ++vb.piece == vb.pieces) vb.pieces = 0;
  } else if (vb.greeted && vb.say) {
    uint16_t size = strlen(vb.say) < 48 ? (uint16_t)strlen(vb.say) : 48;
    p = vb_put(body, VB_SAY | (uint16_t)(vb.say_code * 256u), 2);
    memcpy(p, vb.say, size);
    if (vb_line(body, p + size)) vb.say = 0;
  } else if (vb.greeted && !vb.until_state) {
    vb.until_state = 1000 / VB_RATE;
    p = vb_put(vb_put(vb_put(body, VB_STATE, 1), ++vb.number, 2), vb.now, 4);
    p = vb_put(p, (uint32_t)vb.seen.x - (uint32_t)vb.zero.x, 4);
    p = vb_put(p, (uint32_t)vb.seen.y - (uint32_t)vb.zero.y, 4);
    p = vb_put(p, (uint32_t)vb.seen.turn - (uint32_t)vb.zero.turn, 4);
    p = vb_put(p, vb.taken, 2);
    p = vb_put(p, vb.placed * VB_PLACED + (!vb.ready || vb.resting) * VB_WAITING + vb.faulty * VB_FAULT, 1);
    p = vb_put(p, vb.seen.buttons, 1);
    for (int k = 0; k < 4; k++) p = vb_put(p, vb.seen.knobs[k], 1);
    p = vb_put(vb_put(p, vb.trips, 1), vb.dropped, 1);
    for (int k = 0; k < VB_ANALOG; k++) p = vb_put(p, (uint16_t)vb.seen.analog[k], 2);
    vb_line(body, p);
  }
}
static inline void vb_tick(uint32_t us, const vb_input *input) {         /* us: a clock that wraps at 2^32 */
  vb_level most, busy = 0;
  vb.now = us;
  vb.seen = *input;
  if (vb.armed && (++vb.age >= 50 || us - vb.taken_at >= 48000)) { vb.trips++; vb_rest(0); }
  most = vb.resting ? VB_SLOW : VB_FAST;
  for (uint16_t i = 0; i < VB_N; i++) {
    vb_level here = vb.level[i], goal = vb.goal[i];
    if (here < goal) here += goal - here < most ? goal - here : most;
    else here -= here - goal < most ? here - goal : most;
    busy |= vb.level[i] = here;
  }
  if (!busy) vb.resting = 0;
  vb_drive(vb.level);
  vb_speak();
}
#endif
