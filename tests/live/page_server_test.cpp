#include "live/page_server.h"

#include "base/error.h"
#include "helpers/free_port.h"
#include "helpers/running_program.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using boost::asio::ip::tcp;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A browser's connection.
class Visitor {
  public:
    explicit Visitor(std::uint16_t port) { socket_.connect({boost::asio::ip::address_v4::loopback(), port}); }

    void ask(const std::string& request) { boost::asio::write(socket_, boost::asio::buffer(request)); }
    /// What comes until `last` does, or until the other end closes.
    std::string hear_until(const std::string& last) {
        std::string heard;
        test::wait_until([&] {
            boost::system::error_code error;
            std::string more(4096, '\0');
            socket_.non_blocking(true);
            more.resize(socket_.read_some(boost::asio::buffer(more), error));
            heard += more;
            return (error && error != boost::asio::error::would_block) ||
                   (!last.empty() && heard.find(last) != std::string::npos);
        });
        return heard;
    }
    std::string hear_all() { return hear_until(""); }

  private:
    boost::asio::io_context context_;
    tcp::socket socket_{context_};
};

class PageServerTest : public testing::Test {
  protected:
    const std::uint16_t port = test::free_udp_port();
    PageServer server{std::to_string(port), "<!DOCTYPE html><p>page"};

    std::string answer_to(const std::string& line, const std::string& headers = "Host: localhost\r\n") {
        Visitor visitor(port);
        visitor.ask(line + " HTTP/1.1\r\n" + headers + "\r\n");
        return visitor.hear_all();
    }
};

TEST_F(PageServerTest, AnswersWithThePageAndTheState) {
    EXPECT_EQ(server.address(), fmt::format("http://127.0.0.1:{}/", port));
    const auto page = answer_to("GET /");
    EXPECT_THAT(page, StartsWith("HTTP/1.1 200 OK\r\n"));
    EXPECT_THAT(page, testing::EndsWith("\r\n\r\n<!DOCTYPE html><p>page"));
    EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'"));
    EXPECT_THAT(page, Not(HasSubstr("unsafe-eval")));
    EXPECT_THAT(answer_to("HEAD /"), testing::EndsWith("\r\n\r\n"));
    EXPECT_THAT(answer_to("GET /state"), testing::EndsWith("\r\n\r\nnull\n"));
    server.publish("{\"a\": 1}", "");
    ASSERT_TRUE(test::wait_until([&] { return answer_to("GET /state").ends_with("{\"a\": 1}\n"); }));
}

TEST_F(PageServerTest, RefusesOtherHostsOriginsMethodsAndPaths) {
    EXPECT_THAT(answer_to("GET /", "Host: evil.example\r\n"), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(answer_to("GET /", ""), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(answer_to("GET /state", "Host: localhost\r\nOrigin: http://evil.example\r\n"),
                StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(answer_to("GET /events", "Host: localhost\r\nSec-Fetch-Site: cross-site\r\n"),
                StartsWith("HTTP/1.1 403"));
    for (const auto* command : {"POST /", "PUT /state", "DELETE /events", "PATCH /state", "OPTIONS /"}) {
        const auto answer = answer_to(command);
        EXPECT_THAT(answer, StartsWith("HTTP/1.1 405")) << command;
        EXPECT_THAT(answer, HasSubstr("Allow: GET, HEAD"));
    }
    EXPECT_THAT(answer_to("GET /../etc/passwd"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(answer_to("GET /", "Host: localhost\r\nX: " + std::string(20'000, 'x') + "\r\n"),
                Not(HasSubstr("200 OK")));
    Visitor garbage(port);
    garbage.ask("\x16\x03\x01 this is not HTTP\r\n\r\n");
    EXPECT_EQ(garbage.hear_all(), "");
    EXPECT_THAT(answer_to("GET /"), StartsWith("HTTP/1.1 200"));
}

TEST_F(PageServerTest, TellsListenersWhatWasAndWhatIsNew) {
    for (int i = 0; i < 3; ++i) server.publish(fmt::format("{{\"t\":{}}}", i), fmt::format("[{}]", i));
    Visitor visitor(port);
    visitor.ask("GET /events HTTP/1.1\r\nHost: 127.0.0.1:80\r\n\r\n");
    const auto begin = visitor.hear_until("event: state\ndata: {\"t\":2}\n\n");
    EXPECT_THAT(begin, HasSubstr("Content-Type: text/event-stream"));
    EXPECT_THAT(begin, Not(HasSubstr("Access-Control")));
    EXPECT_THAT(begin, HasSubstr("retry: 1000\n\nevent: begin\ndata: {\"run\":\""));
    EXPECT_THAT(begin, HasSubstr("\"points\":[[0],[1],[2]]}\n\n"));
    server.publish("{\"t\":3}", "[3]");
    EXPECT_EQ(visitor.hear_until("\n\n"), "event: state\ndata: {\"t\":3}\n\n");
}

TEST_F(PageServerTest, KeepsAWholeFlightInBoundedMemory) {
    constexpr int points = 4000;
    for (int i = 0; i < points; ++i) {
        server.publish("{}", fmt::format("[{}]", i));
        if (i % 60 == 59) answer_to("GET /state");  // it has caught up
    }
    Visitor visitor(port);
    visitor.ask("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const auto begin = visitor.hear_until("event: state");
    const auto kept = static_cast<std::size_t>(std::count(begin.begin(), begin.end(), '['));
    EXPECT_LE(kept, PageServer::max_points + 1);
    EXPECT_GE(kept, PageServer::max_points / 2);
    EXPECT_THAT(begin, HasSubstr("\"points\":[[0],"));
    EXPECT_THAT(begin, HasSubstr("[3999]]}"));
}

TEST_F(PageServerTest, BoundsItsConnectionsAndLosesThoseThatTakeNothing) {
    // Each is heard before the next asks: the server may answer those that wait in any order.
    std::vector<std::unique_ptr<Visitor>> many;
    const auto open_another = [&](const std::string& last) {
        many.push_back(std::make_unique<Visitor>(port));
        many.back()->ask("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
        return many.back()->hear_until(last);
    };
    for (std::size_t i = 0; i < PageServer::max_connections; ++i)
        ASSERT_THAT(open_another("event: state\ndata: null\n\n"), HasSubstr("200 OK")) << i;
    for (int i = 0; i < 8; ++i) {
        const auto refused = open_another("");
        EXPECT_THAT(refused, StartsWith("HTTP/1.1 503 Service Unavailable\r\n"));
        EXPECT_THAT(refused, HasSubstr("Retry-After: "));
    }
    server.publish("{\"t\":1}", "");
    EXPECT_THAT(many.front()->hear_until("{\"t\":1}"), HasSubstr("{\"t\":1}")) << "those that are open stay";
    EXPECT_THAT(answer_to("GET /state"), testing::EndsWith("{\"t\":1}\n"));
    std::vector<std::unique_ptr<Visitor>> silent;  // who never ask do not keep others out
    for (std::size_t i = 0; i < 2 * PageServer::max_connections; ++i) silent.push_back(std::make_unique<Visitor>(port));
    EXPECT_THAT(answer_to("GET /"), StartsWith("HTTP/1.1 200"));
    // No one reads: what waits is bounded, and the last page is answered nevertheless.
    const std::string large(100'000, 'x');
    for (int i = 0; i < 300; ++i) server.publish('"' + large + '"', "");
    EXPECT_THAT(answer_to("GET /"), StartsWith("HTTP/1.1 200"));
}

TEST(PageServer, IsRefusedWhereItCannotListen) {
    const auto port = test::free_udp_port();
    const PageServer first(fmt::format("127.0.0.1:{}", port), "");
    EXPECT_THROW(PageServer(std::to_string(port), ""), InputError);
    for (const auto* wrong : {"", "0", "x", "localhost:1", "127.0.0.1:"})
        EXPECT_THROW(PageServer(wrong, ""), UsageError) << wrong;
}

TEST(PageServer, KnowsWhetherOtherMachinesCanConnect) {
    EXPECT_TRUE(PageServer(std::to_string(test::free_udp_port()), "").is_local()) << "by default";
    EXPECT_TRUE(PageServer(fmt::format("127.0.0.1:{}", test::free_udp_port()), "").is_local());
    EXPECT_FALSE(PageServer(fmt::format("0.0.0.0:{}", test::free_udp_port()), "").is_local());
}

TEST(PageServer, CanTakeItsPortAgainAtOnce) {
    const auto port = test::free_udp_port();
    for (int i = 0; i < 3; ++i) {
        const PageServer server(std::to_string(port), "page");
        Visitor visitor(port);
        visitor.ask("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_THAT(visitor.hear_until("event: state"), HasSubstr("200 OK"));
    }
}

TEST_F(PageServerTest, KnowsItsOwnHosts) {
    const auto status_for = [this](const std::string& host) {
        return answer_to("GET /state", "Host: " + host + "\r\n").substr(0, 12);
    };
    for (const auto* own :
         {"localhost", "LocalHost:8080", "127.0.0.1", "127.0.0.1:8080", "[::1]", "[::1]:8080", "192.168.1.7:80"}) {
        EXPECT_EQ(status_for(own), "HTTP/1.1 200") << own;
    }
    for (const auto* other : {"", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example",
                              "localhost:", "localhost:x", "[::1", ":80"}) {
        EXPECT_EQ(status_for(other), "HTTP/1.1 403") << other;
    }
}

}  // namespace
}  // namespace flightwatt::live
