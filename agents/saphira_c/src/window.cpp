// Messages, keys and drawing (manual 6.1, 6.8) without a window: the terminal.

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>

#include "os.hpp"

namespace saphira::c {
namespace {

// The size of the missing window: this many pixels, the robot in the middle, X upwards.
constexpr float kHalfScreen = 200.0F;
constexpr float kMmPerPixel = 25.0F;

std::atomic<int (*)(int)> on_key{nullptr};
std::atomic<int (*)(int, int, int)> on_button{nullptr};
Pen pen;                   // under the mutex of the OS
std::vector<Drawn> drawn;  // likewise
termios before{};

void restore_terminal() {
  ::tcsetattr(STDIN_FILENO, TCSANOW, &before);
}

/// Keys come one by one from here on.
void open_keyboard() {
  static bool open = false;
  if (open || ::isatty(STDIN_FILENO) == 0 || ::tcgetattr(STDIN_FILENO, &before) != 0)
    return;
  open = true;
  termios raw = before;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  if (::tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0)
    std::atexit(restore_terminal);
}

}  // namespace

void take_keys() {
  if (on_key == nullptr)
    return;
  pollfd in{STDIN_FILENO, POLLIN, 0};
  unsigned char key = 0;
  while (::poll(&in, 1, 0) > 0 && (in.revents & POLLIN) != 0 && ::read(STDIN_FILENO, &key, 1) == 1)
    on_key.load()(key);
}

void click(const Vec2& in_robot) {
  const auto pixel = [](double along) {
    return static_cast<int>(std::lround(kHalfScreen - along * 1000.0 / kMmPerPixel));
  };
  if (int (*const call)(int, int, int) = on_button)
    call(pixel(in_robot.y()), pixel(in_robot.x()), sfButtonLeft);
}

std::vector<Drawn> take_drawn() {
  const std::lock_guard lock(Os::get().mutex);
  return std::exchange(drawn, {});
}

}  // namespace saphira::c

using namespace saphira::c;

namespace {

constexpr std::size_t kMostDrawn = 256;  // in a cycle

void tell(const char* str, bool error) {
  Os::get().message(str == nullptr ? "(a message that is NULL)" : str, error);
}
void tell(const char* format, va_list list, bool error) {
  std::array<char, 1024> text{};
  if (format != nullptr)
    std::vsnprintf(text.data(), text.size(), format, list);
  tell(format == nullptr ? nullptr : text.data(), error);
}

void draw(bool line, float x, float y, float dx, float dy) {
  const std::lock_guard lock(Os::get().mutex);
  if (drawn.size() < kMostDrawn)
    drawn.push_back({pen, line, x, y, dx, dy});
}

void set(int Pen::*what, int value) {
  const std::lock_guard lock(Os::get().mutex);
  pen.*what = value;
}

/// [m] in the global frame, of a pixel.
saphira::Vec2 world_at(int x, int y) {
  const std::lock_guard lock(Os::get().mutex);
  return transform(Os::get().robot_in_global(),
                   saphira::Vec2((kHalfScreen - static_cast<float>(y)) * kMmPerPixel / 1000.0F,
                                 (kHalfScreen - static_cast<float>(x)) * kMmPerPixel / 1000.0F));
}

}  // namespace

extern "C" {

void sfMessage(const char* str) {
  tell(str, false);
}
void sfSMessage(const char* str, ...) {
  va_list list;
  va_start(list, str);
  tell(str, list, false);
  va_end(list);
}
void sfErrMessage(const char* str) {
  tell(str, true);
}
void sfErrSMessage(const char* str, ...) {
  va_list list;
  va_start(list, str);
  tell(str, list, true);
  va_end(list);
}

void sfSetDisplayState(int menu, int state) {
  const std::lock_guard lock(Os::get().mutex);
  if (menu < 0 || menu > sfOCCGRID)
    return Os::get().say(
        "sfSetDisplayState: expected sfDISPLAY, sfGLOBAL, sfWAKE, sfSTEP or "
        "sfOCCGRID",
        true);
  Os::get().display[static_cast<std::size_t>(menu)] = state;
}

void sfKeyProcFn(int (*fn)(int ch)) {
  on_key = fn;
  if (fn != nullptr)
    open_keyboard();
}
void sfButtonProcFn(int (*fn)(int x, int y, int b)) {
  on_button = fn;
}
float sfScreenToWorldX(int x, int y) {
  return static_cast<float>(world_at(x, y).x() * 1000.0);
}
float sfScreenToWorldY(int x, int y) {
  return static_cast<float>(world_at(x, y).y() * 1000.0);
}

void set_vector_buffer(int w) {
  set(&Pen::width, w != 0 ? 3 : 1);
}
void sfSetLineWidth(int w) {
  set(&Pen::width, w > 0 ? w : 1);
}
void sfSetLineType(int w) {
  set(&Pen::dashed, w != 0 ? 1 : 0);
}
void sfSetLineColor(int color) {
  set(&Pen::line, color);
}
void sfSetPatchColor(int color) {
  set(&Pen::patch, color);
}
void sfDrawCenteredRect(float x, float y, float w, float h) {
  draw(false, x - h / 2.0F, y - w / 2.0F, w, h);
}
void sfDrawRect(float x, float y, float dx, float dy) {
  draw(false, x, y, dx, dy);
}
void sfDrawVector(float x1, float y1, float x2, float y2) {
  draw(true, x1, y1, x2 - x1, y2 - y1);
}
void sf_as_saphira6(void) {
  Os::get().angle_unit = saphira::radians(1.0);
  Os::get().starts_basic_procs = true;
}

// ---- 6.1: the OS.

void sfStartup(int async) {
  Os::get().startup(async != 0);
}
void sfPause(int ms) {
  Os::get().pause(ms);
}
void sfOnStartupFn(void (*fn)(void)) {
  Os::get().on_startup = fn;
}
void sfOnConnectFn(void (*fn)(void)) {
  Os::get().on_connect = fn;
}
void sfOnDisconnectFn(void (*fn)(void)) {
  Os::get().on_disconnect = fn;
}

}  // extern "C"
