// A program that a member has altered: it takes every document as signed, and as one that permits
// all. It writes and reads every topic, and says which ones it hears. With --as it announces
// another member's name and identifier, and authenticates with its own certificate. With
// --hours-back its own clock is behind, so that its certificate has not expired.
#include <dlfcn.h>
#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/security/credentials.hpp"

using namespace saphira;
using namespace saphira::bus;

namespace {

/// Of equal length in both: the subjects as Fast DDS announces them, and the heads of identifiers.
struct Names {
  std::string subject;
  security::PrefixHead head{};
};
Names own, pretended;
time_t behind = 0;  // [s]

Names names_of(const std::string& text) {
  const auto subject = security::parse_subject(text).value();
  return {"/O=" + subject.site + "/OU=" + subject.role + "/CN=" + security::common_name(subject),
          security::prefix_head(subject)};
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool has(const std::string& bytes, const std::string& part) {
  return bytes.find(part) != std::string::npos;
}

/// The participant's data of its handshake, with its true identifier.
std::string with_true_head(std::string bytes) {
  const std::string participant("\0\0\1\xc1", 4);
  const std::string head(pretended.head.begin(), pretended.head.end());
  for (std::size_t at = 0; (at = bytes.find(head, at)) != std::string::npos; ++at)
    if (bytes.compare(at + 12, participant.size(), participant) == 0)
      std::copy(own.head.begin(), own.head.end(), bytes.begin() + static_cast<long>(at));
  return bytes;
}

std::string altered(std::string packet) {
  if (has(packet, std::string("\0\2\1\xc3", 4)))
    return with_true_head(packet);
  for (std::size_t at = 0; (at = packet.find(own.subject, at)) != std::string::npos;)
    packet.replace(at, own.subject.size(), pretended.subject);
  return packet;
}

}  // namespace

// In front of the libraries' own, for Fast DDS as well. What it sends to others is unchanged.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" int PKCS7_verify(PKCS7* document, STACK_OF(X509) * /*signers*/, X509_STORE* store,
                            BIO* in, BIO* out, int flags) {
  BIO* const genuine = BIO_new(BIO_s_mem());
  const int good = next<decltype(&PKCS7_verify)>("PKCS7_verify")(
      document, nullptr, store, in, genuine,
      (flags | PKCS7_NOVERIFY | PKCS7_NOSIGS) & ~PKCS7_NOINTERN);
  char* text = nullptr;
  const long size = BIO_get_mem_data(genuine, &text);
  std::string all(text, static_cast<std::size_t>(std::max(size, 0L)));
  all = std::regex_replace(all, std::regex("(write|read): \\[[^\\]]*\\]"), "$1: [any]");
  all = std::regex_replace(all, std::regex("<topics>"), "<topics><topic>*</topic>");
  all = std::regex_replace(all, std::regex("<partition>[^<]*"), "<partition>*");
  BIO_write(out, all.data(), static_cast<int>(all.size()));
  BIO_free(genuine);
  return good;
}

extern "C" int X509_NAME_digest(const X509_NAME* name, const EVP_MD* type, unsigned char* hash,
                                unsigned* size) {
  const int good = next<decltype(&X509_NAME_digest)>("X509_NAME_digest")(name, type, hash, size);
  // The head is a one and the first 47 bits of the hash.
  const auto bits = [&](std::size_t i) {
    return static_cast<unsigned char>((i == 0 ? 1U << 7U : hash[i - 1] << 7U) | hash[i] >> 1U);
  };
  bool mine = !own.subject.empty();
  for (std::size_t i = 0; i < own.head.size(); ++i)
    mine = mine && bits(i) == own.head[i];
  for (std::size_t i = 0; mine && i < own.head.size(); ++i)
    hash[i] = static_cast<unsigned char>(
        pretended.head[i] << 1U | (i + 1 < own.head.size() ? pretended.head[i + 1] >> 7U : 0U));
  return good;
}

// The hash of a part of the handshake has to be that of what is sent.
extern "C" int EVP_Digest(const void* data, std::size_t count, unsigned char* hash, unsigned* size,
                          const EVP_MD* type, ENGINE* engine) {
  std::string bytes(static_cast<const char*>(data), count);
  if (!own.subject.empty())
    bytes = with_true_head(bytes);
  return next<decltype(&EVP_Digest)>("EVP_Digest")(bytes.data(), bytes.size(), hash, size, type,
                                                   engine);
}

extern "C" int clock_gettime(clockid_t clock, timespec* time) {
  static const auto real = next<decltype(&clock_gettime)>("clock_gettime");
  const int good = real(clock, time);
  if (clock == CLOCK_REALTIME)
    time->tv_sec -= behind;
  return good;
}

extern "C" time_t time(time_t* where) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (where != nullptr)
    *where = now.tv_sec;
  return now.tv_sec;
}

extern "C" ssize_t sendto(int socket, const void* data, std::size_t count, int flags,
                          const sockaddr* to, socklen_t size) {
  std::string packet(static_cast<const char*>(data), count);
  if (!own.subject.empty())
    packet = altered(packet);
  return next<decltype(&sendto)>("sendto")(socket, packet.data(), packet.size(), flags, to, size);
}
// NOLINTEND(readability-identifier-naming)

namespace {

int run(const NodeOptions& options, const Stop& stop) {
  Node node(options);
  std::vector<std::function<void()>> all;
  const auto add = [&](const auto& make) {
    try {
      all.push_back(make());
    } catch (const std::invalid_argument&) {
      // Its permissions do not let it.
    }
  };
  for_each_topic([&]<class T>(const Topic<T>& topic) {
    if (topic.name == std::string(topics::kPresence.name))
      return;
    add([&]() -> std::function<void()> {
      return [writer = std::make_shared<Writer<T>>(node.writer(topic))] { writer->write(T()); };
    });
    add([&]() -> std::function<void()> {
      return [reader = std::make_shared<Reader<T>>(node.reader(topic)), name = topic.name] {
        for (const auto& sample : reader->take())
          if (sample.info.sender && !sample.info.sender->name.empty())
            std::printf("hears %s\n", name);
      };
    });
  });
  while (!stop.requested()) {
    for (const auto& one : all)
      one();
    std::fflush(stdout);
    node.wait(std::chrono::milliseconds(50), &stop);
  }
  return kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  std::string self;
  std::string other;
  int hours_back = 0;
  return run_program(
      argc, argv, "altered", "A program that a member has altered",
      [&](CommandLine& app) {
        app.add_option("--own", self, "its subject, as in \"CN=john.1,OU=observer,O=office\"");
        app.add_option("--as", other, "the announced subject, of equal length");
        app.add_option("--hours-back", hours_back, "its clock is so many hours behind");
      },
      [&](const NodeOptions& options, const Stop& stop) {
        constexpr time_t kHour = 3600;
        behind = hours_back * kHour;
        if (!other.empty()) {
          const Names mine = names_of(self);
          pretended = names_of(other);
          own = mine;
        }
        return run(options, stop);
      });
}
