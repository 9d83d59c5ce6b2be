// The servers of the network, each in a thread of this test: where they listen, and what they take.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "foxglove_server.hpp"
#include "http.hpp"
#include "process.hpp"
#include "relay.hpp"
#include "server.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;
using test::has;
using test::trouble_of;

/// The inodes of this program's sockets.
std::set<std::string> own_sockets() {
  std::set<std::string> own;
  for (const auto& each : fs::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    const std::string target = fs::read_symlink(each.path(), error).string();
    if (target.starts_with("socket:["))
      own.insert(target.substr(8, target.size() - 9));
  }
  return own;
}

/// The addresses at which this program listens, by the system's own list.
std::multiset<std::string> listening() {
  std::multiset<std::string> found;
  const std::set<std::string> own = own_sockets();
  for (const char* file : {"/proc/self/net/tcp", "/proc/self/net/tcp6"}) {
    std::ifstream lines(file);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string number, local, remote, state, skipped, inode;
      words >> number >> local >> remote >> state;
      for (int i = 0; i < 5; ++i)
        words >> skipped;
      words >> inode;
      if (state != "0A" || !own.contains(inode))
        continue;
      // Words of four bytes, each in the order of this machine.
      const std::string digits = local.substr(0, local.find(':'));
      std::array<std::uint32_t, 4> address{};
      for (std::size_t i = 0; i < digits.size() / 8; ++i)
        address.at(i) =
            static_cast<std::uint32_t>(std::stoul(digits.substr(8 * i, 8), nullptr, 16));
      std::array<char, 64> text{};
      inet_ntop(digits.size() == 8 ? AF_INET : AF_INET6, address.data(), text.data(), text.size());
      found.insert(text.data());
    }
  }
  return found;
}

using Addresses = std::multiset<std::string>;

console::Server::Events no_events() {
  return {[](auto, auto, const auto&) {},
          [](auto, const auto&) { return true; },
          [](auto) {},
          [](auto) { return std::nullopt; },
          [] {},
          [] {}};
}

TEST(Servers, EachListensAtTheAddressThatWasSaidAndNowhereElse) {
  for (const char* address : {"127.0.0.1", "127.0.0.5", "0.0.0.0", "::1", "::"}) {
    {
      const console::Server server({{address, 0, {}, {}}, 1, 0, false}, {}, {}, no_events());
      EXPECT_EQ(listening(), Addresses{address}) << "console";
    }
    {
      const relay::Relay server({{address, 0, {}, {}}},
                                {{"a", 0, "0123456789abcdef"}, {"b", 0, "fedcba9876543210"}});
      EXPECT_EQ(listening(), (Addresses{address, address, "127.0.0.1"})) << "relay";
    }
    {
      const viewer::Server server({{address, 0, {}, {}}, {}, {}, {}, {}}, {}, {});
      EXPECT_EQ(listening(), Addresses{address}) << "viewer";
    }
  }
  const mcp::HttpServer server(0, {});
  EXPECT_EQ(listening(), Addresses{"127.0.0.1"}) << "mcp";
}

TEST(Servers, VisitorsOfARelayHaveAnAddressOfTheirOwn) {
  const console::Server server({{"::1", 0, {}, {}}, 1, 0, true}, {}, {}, no_events());
  EXPECT_EQ(listening(), (Addresses{"::1", console::kRelayed}));
}

TEST(Servers, AnAddressOfAnotherMachineIsNoPlaceToListen) {
  for (const char* address : {"192.0.2.7", "2001:db8::7"})
    EXPECT_NE(trouble_of<std::runtime_error>([&] {
                console::Server({{address, 0, {}, {}}, 1, 0, false}, {}, {}, no_events());
              }),
              "");
  EXPECT_NE(trouble_of<std::invalid_argument>([&] {
              console::Server({{"nowhere", 0, {}, {}}, 1, 0, false}, {}, {}, no_events());
            }),
            "");
}

/// Runs a server until its end.
template <class S>
class Running {
 public:
  template <class... Arguments>
  explicit Running(Arguments&&... arguments)
      : server_(std::forward<Arguments>(arguments)...), thread_([this] { server_.run(stop_); }) {}
  ~Running() {
    eventfd_write(stop_, 1);
    thread_.join();
    close(stop_);
  }
  S* operator->() { return &server_; }

 private:
  int stop_ = eventfd(0, EFD_CLOEXEC);
  S server_;
  std::thread thread_;
};

int connected(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return fd;
}

/// The answer to a request, until the server closes the connection or, with an end, until that.
std::string answer(int port, const std::vector<std::string>& pieces, const std::string& end = {}) {
  const int fd = connected(port);
  for (const std::string& piece : pieces)
    EXPECT_EQ(send(fd, piece.data(), piece.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(piece.size()));
  std::string all;
  std::array<char, 4096> buffer{};
  while (end.empty() || !has(all, end)) {
    const ssize_t size = recv(fd, buffer.data(), buffer.size(), 0);
    if (size <= 0)
      break;
    all.append(buffer.data(), static_cast<std::size_t>(size));
  }
  close(fd);
  return all;
}

/// A server that tells each request what it has understood of it.
class Echo {
 public:
  Echo() : server_(0, events()) {}
  int port() { return server_->port(); }

 private:
  mcp::HttpServer::Events events() {
    return {[](const mcp::HttpRequest& request) { return request.authorization == "Bearer key"; },
            [this](auto exchange, const mcp::HttpRequest& request) {
              server_->answer(exchange, 200, "text/plain",
                              request.method + " " + request.path + " " + request.caller.host +
                                  " " + std::to_string(request.body.size()) + " " +
                                  request.body.substr(0, 20) +
                                  (request.caller.loopback ? "" : "by a proxy") + request.mcp_name);
            },
            [](auto) {}, [] {}, [] {}};
  }
  Running<mcp::HttpServer> server_;
};

std::string post(const std::string& headers) {
  return "POST /a/mcp HTTP/1.1\r\nHost: robot\r\nAuthorization: Bearer key\r\n" + headers + "\r\n";
}

TEST(Servers, ABodyMayComeInChunks) {
  Echo echo;
  const std::string head = post("Transfer-Encoding: chunked\r\n");
  const std::string body = "5\r\nhello\r\n7\r\n, world\r\n0\r\n\r\n";
  EXPECT_TRUE(has(answer(echo.port(), {head + body}), "POST /a/mcp robot 12 hello, world"));
  std::vector<std::string> pieces{head};
  for (const char byte : body)
    pieces.emplace_back(1, byte);
  EXPECT_TRUE(has(answer(echo.port(), pieces), "POST /a/mcp robot 12 hello, world"));
  EXPECT_EQ(answer(echo.port(), {head + "hello\r\n"}), "");
}

TEST(Servers, AHeaderThatIsNotAsciiComesAsBase64) {
  Echo echo;
  const auto named = [&](const std::string& name) {
    const std::string all = answer(
        echo.port(), {"GET /mcp HTTP/1.1\r\nHost: localhost\r\nMcp-Name: " + name + "\r\n\r\n"});
    return all.substr(all.find("localhost 0 ") + 12);
  };
  EXPECT_EQ(named("go"), "go");
  EXPECT_EQ(named("=?base64?S8O8Y2hl?="), "Küche");
  EXPECT_EQ(named("=?base64?Z28=?="), "go");
  EXPECT_EQ(named("=?base64?no base64?="), "");
  EXPECT_EQ(named("=?base64?="), "=?base64?=");
}

TEST(Servers, ABodyMayBeLongerThan64Kilobytes) {
  Echo echo;
  const std::string body(300'000, 'x');
  EXPECT_TRUE(has(answer(echo.port(), {post("Content-Length: 300000\r\n"), body}),
                  "POST /a/mcp robot 300000 xxx"));
  const std::string longest = std::to_string(mcp::HttpServer::kLongestBody + 1);
  EXPECT_TRUE(has(answer(echo.port(), {post("Content-Length: " + longest + "\r\n"),
                                       std::string(mcp::HttpServer::kLongestBody + 1, 'x')}),
                  "413"));
}

TEST(Servers, TheBodyOfAStrangerIsNotKept) {
  Echo echo;
  EXPECT_TRUE(has(answer(echo.port(), {"POST /mcp HTTP/1.1\r\nHost: robot\r\nContent-Length: 5"
                                       "\r\n\r\nhello"}),
                  "POST /mcp robot 0 "));
}

TEST(Servers, AProxyNamesTheHostThatWasAskedFor) {
  Echo echo;
  EXPECT_TRUE(has(answer(echo.port(), {"GET /mcp HTTP/1.0\r\nHost: 127.0.0.1:1\r\n"
                                       "X-Forwarded-Host: robot.example:8443, inner\r\n\r\n"}),
                  "GET /mcp robot.example:8443 0 "));
}

TEST(Servers, AProxyThatSaysNothingSpeaksHttp10) {
  Echo echo;
  EXPECT_TRUE(answer(echo.port(), {"GET /mcp HTTP/1.1\r\nHost: localhost\r\n\r\n"})
                  .ends_with("GET /mcp localhost 0 "));
  EXPECT_TRUE(answer(echo.port(), {"GET /mcp HTTP/1.0\r\nHost: localhost\r\n\r\n"})
                  .ends_with("GET /mcp localhost 0 by a proxy"));
}

/// A request for a WebSocket; its headers end with `more`.
std::string upgrade(const std::string& path, const std::string& more) {
  return "GET " + path +
         " HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n" +
         more + "\r\n";
}

/// A console with a page, which notes its callers.
class Console {
 public:
  explicit Console(web::Place place = {"127.0.0.1", 0, {}, {}})
      : server_(options(place), access(), page(), events()) {}
  int port() { return server_->port(); }
  std::string get(const std::string& path, const std::string& headers) {
    return answer(port(), {"GET " + path + " HTTP/1.1\r\n" + headers + "\r\n"});
  }
  /// The caller of a WebSocket; nothing: it was refused.
  std::optional<console::Caller> open(const std::string& headers) {
    const std::string told = answer(
        port(),
        {upgrade("/under/a/path/", "Sec-WebSocket-Protocol: saphira.telemetry\r\n" + headers)},
        "\r\n\r\n");
    std::unique_lock lock(mutex_);
    if (!has(told, " 101 "))
      return std::nullopt;
    came_.wait(lock, [&] { return !callers_.empty(); });
    const console::Caller caller = callers_.back();
    callers_.clear();
    return caller;
  }

 private:
  static console::ServerOptions options(const web::Place& place) { return {place, 1, 0, false}; }
  static console::AccessSettings access() { return {"key", {"robot.example"}, 0, false}; }
  static std::vector<console::PageFile> page() {
    return {{"/index.html", "<style>s</style><script type=\"module\">t</script><p>the page</p>"}};
  }
  console::Server::Events events() {
    console::Server::Events events = no_events();
    events.opened = [this](auto, auto, const console::Caller& caller) {
      const std::lock_guard lock(mutex_);
      callers_.push_back(caller);
      came_.notify_all();
    };
    return events;
  }
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<console::Caller> callers_;
  Running<console::Server> server_;
};

TEST(Servers, ThePageIsThereUnderThePathOfAProxy) {
  Console console;
  const std::string host = "Host: localhost\r\n";
  EXPECT_TRUE(has(console.get("/", host), "the page"));
  EXPECT_TRUE(has(console.get("/under/a/path/", host), "the page"));
  EXPECT_TRUE(has(console.get("/under/a/path", host), "404"));
  EXPECT_TRUE(has(answer(console.port(), {"GET / HTTP/1.0\r\n" + host + "\r\n"}), "the page"))
      << "as nginx speaks";
  EXPECT_TRUE(
      has(console.get("/", host + "Cookie: " + std::string(6000, 'x') + "\r\n"), "the page"))
      << "of other programs behind the same proxy";
}

TEST(Servers, ThePageIsSentOnceAndRunsItsOwnScriptAlone) {
  Console console;
  const std::string host = "Host: localhost\r\n";
  const std::string plain = console.get("/", host);
  EXPECT_TRUE(has(plain,
                  "script-src 'sha256-47mKTaMaEn1L3m5DAz9muidMqw636xxw7EFAK/YnPdg='; "
                  "style-src 'sha256-BDpxh3TFcr2KJa2+sb/NXAJWrhHOz5+cP5JdDlK+r4k='; "))
      << plain;
  const std::size_t at = plain.find("etag: ") + 6;
  const std::string tag = plain.substr(at, plain.find('\r', at) - at);
  const std::string again = console.get("/", host + "If-None-Match: " + tag + "\r\n");
  EXPECT_TRUE(has(again, " 304 ") && again.ends_with("\r\n\r\n")) << again;
  EXPECT_TRUE(has(console.get("/", host + "If-None-Match: \"another\"\r\n"), "the page"));
  const std::string zipped = console.get("/", host + "Accept-Encoding: br, gzip\r\n");
  EXPECT_TRUE(has(zipped, "content-encoding: gzip") && has(zipped, "\r\n\r\n\x1F\x8B")) << zipped;
}

TEST(Servers, APageHearsWhyItsWebSocketIsRefused) {
  Console console;
  const std::string other =
      console.get("/access?origin=https%3A%2F%2Fother.example", "Host: 127.0.0.1\r\n");
  EXPECT_TRUE(has(other, "200")) << other;
  EXPECT_TRUE(has(other, "--host-name other.example")) << other;
  const std::string origin = "Host: 127.0.0.1\r\nOrigin: https://other.example\r\n";
  EXPECT_TRUE(has(console.get("/", origin), "403"));
  const std::string known =
      console.get("/access?origin=https://robot.example", "Host: 127.0.0.1\r\n");
  EXPECT_TRUE(has(known, "200") && known.ends_with("\r\n\r\n")) << known;
}

TEST(Servers, WhoComesByAProxyIsNotOfThisMachine) {
  Console console;
  const std::string host = "Host: localhost:" + std::to_string(console.port()) + "\r\n";
  ASSERT_TRUE(console.open(host));
  EXPECT_TRUE(console.open(host)->loopback);
  for (const char* header :
       {"X-Forwarded-For: 192.0.2.7", "X-Forwarded-Host: localhost", "X-Forwarded-Proto: https",
        "Forwarded: for=192.0.2.7", "X-Real-IP: 192.0.2.7", "Via: 1.1 proxy"}) {
    const auto caller = console.open(host + header + "\r\n");
    ASSERT_TRUE(caller) << header;
    EXPECT_FALSE(caller->loopback) << header;
  }
  EXPECT_FALSE(console.open(host + "Origin: https://other.example\r\n"));
  EXPECT_TRUE(console.open(host + "Origin: https://robot.example:8443\r\n"));
}

/// No protocol, and those that no client may ask for.
const std::vector<std::string> kNoProtocols{"", "Sec-WebSocket-Protocol: descriptor\r\n",
                                            "Sec-WebSocket-Protocol: http\r\n",
                                            "Sec-WebSocket-Protocol: other\r\n"};
/// Each of them is refused.
void expect_no_socket(int port, const std::string& path = "/") {
  EXPECT_EQ(answer(port, {"GET " + path +
                          " HTTP/1.1\r\nHost: localhost\r\nUpgrade: h2c\r\nConnection: Upgrade, "
                          "HTTP2-Settings\r\nHTTP2-Settings: AAMAAABkAAQAAP__\r\n\r\n"}),
            "")
      << "HTTP/2";
  for (const std::string& protocol : kNoProtocols)
    EXPECT_EQ(answer(port, {upgrade(path, "Host: localhost\r\n" + protocol)}, "\r\n\r\n"), "")
        << protocol;
}

TEST(Servers, AWebSocketWithoutAProtocolOfTheServerIsRefused) {
  Console console;
  expect_no_socket(console.port());
  EXPECT_TRUE(console.open("Host: localhost\r\n"));
  Echo echo;
  expect_no_socket(echo.port(), "/mcp");
  const viewer::Server::Options options{{"127.0.0.1", 0, {}, {}},
                                        "robot",
                                        [](const auto& key) { return key == "k"; },
                                        [](auto) {},
                                        [](auto) {}};
  const viewer::Server::Events events{[](auto) {}, [] {}, [] {}};
  Running<viewer::Server> viewer(options, std::vector<viewer::Channel>(), events);
  expect_no_socket(viewer->port());
  expect_no_socket(viewer->port(), "/?key=k");
  const std::string known = "Host: localhost\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n";
  EXPECT_TRUE(has(answer(viewer->port(), {upgrade("/?key=k", known)}, "\r\n\r\n"), " 101 "));
  EXPECT_TRUE(has(answer(viewer->port(), {upgrade("/?key=other", known)}, "\r\n\r\n"), " 403 "));
}

/// A certificate and its key, for a name, in two files.
void write_certificate(const fs::path& folder, const std::string& name, EVP_PKEY* key) {
  const std::unique_ptr<X509, decltype(&X509_free)> certificate(X509_new(), X509_free);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -60);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600);
  X509_set_pubkey(certificate.get(), key);
  X509_NAME* const subject = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  X509_set_issuer_name(certificate.get(), subject);
  X509_sign(certificate.get(), key, EVP_sha256());
  const auto write = [&](const char* file, const auto& put) {
    FILE* const out = std::fopen((folder / file).c_str(), "w");
    put(out);
    std::fclose(out);
  };
  write("cert.pem", [&](FILE* out) { PEM_write_X509(out, certificate.get()); });
  write("key.pem",
        [&](FILE* out) { PEM_write_PrivateKey(out, key, nullptr, nullptr, 0, nullptr, nullptr); });
}

/// The name in the certificate that a server shows.
std::string certified(int port) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()),
                                                                  SSL_CTX_free);
  const std::unique_ptr<SSL, decltype(&SSL_free)> ssl(SSL_new(context.get()), SSL_free);
  const int fd = connected(port);
  SSL_set_fd(ssl.get(), fd);
  std::array<char, 100> name{};
  if (SSL_connect(ssl.get()) == 1) {
    const std::unique_ptr<X509, decltype(&X509_free)> shown(SSL_get1_peer_certificate(ssl.get()),
                                                            X509_free);
    X509_NAME_get_text_by_NID(X509_get_subject_name(shown.get()), NID_commonName, name.data(),
                              static_cast<int>(name.size()));
  }
  close(fd);
  return name.data();
}

TEST(Servers, ARenewedCertificateIsServedWithoutARestart) {
  const test::TempDir folder;
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> curve(EVP_EC_gen("P-256"),
                                                                  EVP_PKEY_free);
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> rsa(EVP_RSA_gen(2048), EVP_PKEY_free);
  write_certificate(folder.path(), "first", curve.get());
  Console console({"127.0.0.1", 0, folder.path("cert.pem"), folder.path("key.pem")});
  EXPECT_EQ(certified(console.port()), "first");
  const auto becomes = [&](const std::string& name) {
    return test::wait_until([&] { return certified(console.port()) == name; });
  };
  write_certificate(folder.path(), "second", rsa.get());
  EXPECT_TRUE(becomes("second")) << "another kind of key";
  std::ofstream(folder.path("cert.pem")) << "in the middle of its change";
  EXPECT_EQ(certified(console.port()), "second");
  write_certificate(folder.path(), "third", curve.get());
  EXPECT_TRUE(becomes("third"));
}

}  // namespace
}  // namespace saphira
