#include "speech/shell/audio.hpp"

#include <alsa/asoundlib.h>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <utility>

#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"

namespace saphira::speech {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kBlock = kRate / 50;
constexpr std::size_t kMost = 10 * kRate;              // samples in the queue
constexpr unsigned kLatency = 100'000;                 // [us] of a device
constexpr std::chrono::milliseconds kAgain{5000};      // between two attempts with a device
constexpr std::chrono::milliseconds kPollPeriod{200};  // within which a thread notices its end
constexpr std::chrono::seconds kHang{2};               // without progress of a device

struct ClosePcm {
  void operator()(snd_pcm_t* pcm) const { snd_pcm_close(pcm); }
};
using Pcm = std::unique_ptr<snd_pcm_t, ClosePcm>;

void say_nothing(const char* /*file*/, int /*line*/, const char* /*function*/, int /*error*/,
                 const char* /*format*/, ...) {}

std::runtime_error not_opened(const std::string& name, snd_pcm_stream_t direction, int error) {
  return std::runtime_error(
      "the sound device \"" + name + "\" cannot be opened: " + snd_strerror(error) +
      (direction == SND_PCM_STREAM_CAPTURE
           ? ". Connect a microphone, or name one with --microphone (in a deployment, the setting "
             "microphone): arecord -L lists them, for users of the group audio"
           : ". Connect a loudspeaker, or name one with --speaker (in a deployment, the setting "
             "loudspeaker): aplay -L lists them, for users of the group audio"));
}

Pcm open_device(const std::string& name, snd_pcm_stream_t direction) {
  snd_lib_error_set_handler(say_nothing);
  snd_pcm_t* raw = nullptr;
  int error = snd_pcm_open(&raw, name.c_str(), direction, 0);
  Pcm pcm(error < 0 ? nullptr : raw);
  if (error >= 0)
    error = snd_pcm_set_params(pcm.get(), SND_PCM_FORMAT_S16_LE, SND_PCM_ACCESS_RW_INTERLEAVED, 1,
                               kRate, 1, kLatency);
  if (error < 0)
    throw not_opened(name, direction, error);
  return pcm;
}

std::string trouble_of(const std::string& name, snd_pcm_stream_t direction) {
  if (name == "none" || name == "-" || fs::exists(name))
    return {};
  snd_lib_error_set_handler(say_nothing);
  snd_pcm_t* raw = nullptr;
  const int error = snd_pcm_open(&raw, name.c_str(), direction, SND_PCM_NONBLOCK);
  const Pcm pcm(error < 0 ? nullptr : raw);
  return error < 0 && error != -EBUSY ? not_opened(name, direction, error).what() : "";
}

/// The error after a device has failed for good.
std::runtime_error failed(const std::string& device, snd_pcm_sframes_t error) {
  return std::runtime_error("the sound device \"" + device +
                            "\": " + snd_strerror(static_cast<int>(error)));
}

}  // namespace

std::string microphone_trouble(const std::string& source) {
  return trouble_of(source, SND_PCM_STREAM_CAPTURE);
}

std::string speaker_trouble(const std::string& sink) {
  return trouble_of(sink, SND_PCM_STREAM_PLAYBACK);
}

Microphone::Microphone(std::string source, std::function<void(const std::string&)> trouble)
    : source_(std::move(source)),
      trouble_(std::move(trouble)),
      at_end_(fs::is_regular_file(source_)),
      waiting_(at_end_ ? read_sound(read_bytes(source_), source_) : Sound{}),
      thread_([this] { run(); }) {}

Microphone::~Microphone() {
  stop_ = true;
  taken_.notify_all();
  thread_.join();
}

Sound Microphone::take() {
  const std::lock_guard lock(mutex_);
  taken_.notify_all();
  return std::exchange(waiting_, {});
}

bool Microphone::ended() const {
  const std::lock_guard lock(mutex_);
  return at_end_ && waiting_.empty();
}

bool Microphone::hangs() const {
  const std::lock_guard lock(mutex_);
  return due_ && Clock::now() > *due_;
}

/// waits: sound from a pipe is not lost.
void Microphone::put(const Sound& sound, bool waits) {
  std::unique_lock lock(mutex_);
  while (waits && waiting_.size() > kMost && !stop_)
    taken_.wait_for(lock, kPollPeriod);
  waiting_.insert(waiting_.end(), sound.begin(), sound.end());
  if (waits)
    return;
  due_ = Clock::now() + kHang;
  if (waiting_.size() > kMost)
    waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(kMost));
}

void Microphone::rest() {
  for (auto left = kAgain; left.count() > 0 && !stop_; left -= kPollPeriod)
    std::this_thread::sleep_for(kPollPeriod);
}

void Microphone::run() {
  if (source_ == "none")
    return;
  const auto at_end = [this] {
    const std::lock_guard lock(mutex_);
    return at_end_;
  };
  while (!stop_ && !at_end()) {
    try {
      read_once();
    } catch (const std::exception& error) {
      {
        const std::lock_guard lock(mutex_);
        due_.reset();
      }
      trouble_(error.what());
      rest();
    }
  }
}

void Microphone::read_once() {
  if (source_ == "-") {
    read_pipe(STDIN_FILENO);
    const std::lock_guard lock(mutex_);
    at_end_ = true;
  } else if (fs::is_fifo(source_)) {
    const int file = open(source_.c_str(), O_RDONLY | O_NONBLOCK);
    if (file < 0)
      throw std::runtime_error(cannot_be(source_, "read"));
    read_pipe(file);  // the next writer is read next
    close(file);
  } else {
    read_device();
  }
}

void Microphone::read_pipe(int file) {
  std::string bytes;
  bool begun = false;
  while (!stop_) {
    pollfd ready{file, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(kPollPeriod.count())) <= 0)
      continue;
    std::array<char, 4096> block{};
    const ssize_t count = read(file, block.data(), block.size());
    if (count == 0 && !begun && file != STDIN_FILENO) {
      std::this_thread::sleep_for(kPollPeriod);  // no writer yet
      continue;
    }
    if (count <= 0)
      return;
    begun = true;
    bytes.append(block.data(), static_cast<std::size_t>(count));
    Sound sound(bytes.size() / 2);
    for (std::size_t i = 0; i < sound.size(); ++i)
      sound[i] = static_cast<std::int16_t>(static_cast<unsigned char>(bytes[2 * i]) |
                                           (static_cast<unsigned char>(bytes[2 * i + 1]) << 8));
    bytes.erase(0, 2 * sound.size());
    put(sound, true);
  }
}

void Microphone::read_device() {
  put({}, false);  // opening it may hang, too
  const Pcm pcm = open_device(source_, SND_PCM_STREAM_CAPTURE);
  trouble_("");
  Sound block(kBlock);
  while (!stop_) {
    snd_pcm_sframes_t count = snd_pcm_readi(pcm.get(), block.data(), block.size());
    if (count < 0)
      count = snd_pcm_recover(pcm.get(), static_cast<int>(count), 1);
    if (count < 0)
      throw failed(source_, count);
    put(Sound(block.begin(), block.begin() + count), false);
  }
}

Speaker::Speaker(std::string sink, std::function<void(const std::string&)> trouble)
    : sink_(std::move(sink)), trouble_(std::move(trouble)), thread_([this] { run(); }) {}

Speaker::~Speaker() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  more_.notify_all();
  thread_.join();
}

void Speaker::play(Sound sound) {
  if (sink_ == "none" || hangs())
    return;
  {
    const std::lock_guard lock(mutex_);
    due_ = speaking_ ? due_ : Clock::now() + kHang;
    speaking_ = true;
    waiting_.push_back(std::move(sound));
  }
  more_.notify_all();
}

bool Speaker::speaking() const {
  const std::lock_guard lock(mutex_);
  return speaking_ && Clock::now() <= due_;
}

bool Speaker::hangs() const {
  const std::lock_guard lock(mutex_);
  return speaking_ && Clock::now() > due_;
}

void Speaker::run() {
  trouble_(speaker_trouble(sink_));  // it is opened only to speak
  std::unique_lock lock(mutex_);
  while (true) {
    more_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
    if (stop_)
      return;
    const Sound sound = std::move(waiting_.front());
    waiting_.pop_front();
    due_ = Clock::now() + kHang + std::chrono::milliseconds(1000 * sound.size() / kRate);
    lock.unlock();
    try {
      play_once(sound);
      trouble_("");
    } catch (const std::exception& error) {
      trouble_(error.what());
    }
    lock.lock();
    speaking_ = !waiting_.empty();
  }
}

void Speaker::play_once(const Sound& sound) {
  if (!fs::is_directory(sink_)) {
    play_on_device(sound);
    return;
  }
  const std::string file = sink_ + format("/%04d.wav", ++files_);
  if (!(std::ofstream(file, std::ios::binary) << wav(sound)))
    throw std::runtime_error(cannot_be(file, "written"));
}

void Speaker::play_on_device(const Sound& sound) const {
  const Pcm pcm = open_device(sink_, SND_PCM_STREAM_PLAYBACK);
  for (std::size_t at = 0; at < sound.size();) {
    const std::size_t left = std::min(kBlock, sound.size() - at);
    snd_pcm_sframes_t count = snd_pcm_writei(pcm.get(), sound.data() + at, left);
    if (count < 0)
      count = snd_pcm_recover(pcm.get(), static_cast<int>(count), 1);
    if (count < 0)
      throw failed(sink_, count);
    at += static_cast<std::size_t>(count);
  }
  snd_pcm_drain(pcm.get());
}

}  // namespace saphira::speech
