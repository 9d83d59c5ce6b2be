#include "speech/shell/speech_shell.hpp"

#include <filesystem>
#include <set>
#include <utility>

#include "saphira/base/boot_clock.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira::speech {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

}  // namespace

SpeechShell::SpeechShell(bus::Node& node, const SpeechOptions& options)
    : node_(node),
      options_(options),
      recognizer_({}, read_file(options.pronunciations), options.pronunciations),
      conversation_(recognizer_,
                    agent_interface::Grammar(read_file(options.grammar), options.grammar)),
      voice_(options.voice),
      um_(voice_.say("um")),
      folder_(folder_of(options.grammar), fs::path(options.grammar).extension()),
      microphone_(options.microphone,
                  [this](const std::string& text) {
                    const std::lock_guard lock(mutex_);
                    microphone_trouble_ = text;
                  }),
      speaker_(options.speaker, [this](const std::string& text) {
        const std::lock_guard lock(mutex_);
        speaker_trouble_ = text;
      }) {
  folder_.poll();
}

void SpeechShell::run(const bus::Stop& stop) {
  constexpr std::chrono::milliseconds kPollPeriod{20};
  auto looked = Clock::now();
  // A program that only hears a file ends behind it, when the bus has had its words.
  constexpr std::chrono::seconds kDelivery{3};
  const auto is_done = [&] {
    return ended_ && options_.speaker == "none" && Clock::now() - *ended_ > kDelivery;
  };
  while (!stop.requested() && !is_done()) {
    node_.wait(kPollPeriod, &stop);
    step();
    if (Clock::now() - looked > std::chrono::seconds(1)) {
      reload();
      report();
      looked = Clock::now();
    }
    node_.publish_status();
  }
}

void SpeechShell::step() {
  if (const auto map = maps_.take_newest()) {
    std::set<std::string> names;
    for (const auto& artifact : map->artifacts)
      if (!artifact.name.empty())
        names.insert(artifact.name);
    conversation_.names({names.begin(), names.end()});
  }
  for (const auto& sample : said_.take()) {
    if (sample.info.disposed)
      continue;
    conversation_.said(sample.data.text);
    speaker_.play(voice_.say(sample.data.text));
  }
  const Sound sound = microphone_.take();
  if (!sound.empty())
    tell(conversation_.hear(sound, speaker_.speaking()));
  else if (!ended_ && microphone_.ended()) {
    ended_ = Clock::now();
    tell(conversation_.end());
  }
}

void SpeechShell::tell(const Conversation::Outputs& out) {
  if (out.um)
    speaker_.play(um_);
  for (const Recognized& heard : out.utterances) {
    heard_.write({.id = {node_.instance(), ++number_},
                  .speaker = options_.person,
                  .text = heard.text,
                  .means = v1::UTTERANCE_SPOKEN,
                  .confidence = heard.confidence,
                  .time = unix_time()});
    node_.info("heard: " + heard.text + (heard.confidence < kCertain ? " (not certain)" : ""));
  }
}

void SpeechShell::reload() {
  for (const std::string& name : folder_.poll().changed) {
    if (name != fs::path(options_.grammar).filename())
      continue;
    try {
      conversation_.use(agent_interface::Grammar(read_file(options_.grammar), options_.grammar));
      node_.info("the grammar " + options_.grammar + " was read again");
    } catch (const std::runtime_error& error) {
      node_.error(std::string("the grammar stays as it was: ") + error.what());
    }
  }
}

/// Reports the errors of the sound threads, each once.
void SpeechShell::report() {
  const std::lock_guard lock(mutex_);
  const auto trouble_of = [](const std::string& device, bool hangs, const std::string& told) {
    return hangs ? "the sound device \"" + device + "\" hangs" : told;
  };
  std::string trouble = trouble_of(options_.microphone, microphone_.hangs(), microphone_trouble_);
  if (const std::string speaker = trouble_of(options_.speaker, speaker_.hangs(), speaker_trouble_);
      !speaker.empty())
    trouble += (trouble.empty() ? "" : "; ") + speaker;
  if (trouble == told_)
    return;
  told_ = std::move(trouble);
  if (!told_.empty())
    node_.warn(told_);
  node_.status().state = told_.empty() ? v1::SERVICE_RUNNING : v1::SERVICE_DEGRADED;
  node_.status().reason = told_;
}

}  // namespace saphira::speech
