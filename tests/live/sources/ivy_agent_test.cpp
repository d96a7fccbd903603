// The agent among others: those of a test that state what Ivy's libraries in C and Python state, byte by byte, and its
// like.

#include "live/sources/ivy_agent.h"

#include "helpers/free_port.h"
#include "helpers/running_program.h"
#include "live/received_links.h"
#include "live/sources.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using std::chrono::milliseconds;
using testing::ElementsAre;

/// A connection of the test's own, without any library of Ivy.
class Connection {
  public:
    explicit Connection(asio::io_context& context) : socket(context) {}

    void send_bytes(const std::string& bytes) { socket.write_some(asio::buffer(bytes)); }
    /// What has come until `last` was seen; empty where it never is.
    std::string hear_until(const std::string& last) {
        const bool heard = test::wait_until([&] {
            std::string more(socket.available(), '\0');
            if (!more.empty()) more.resize(socket.read_some(asio::buffer(more)));
            heard_ += more;
            return heard_.find(last) != std::string::npos;
        });
        return heard ? std::exchange(heard_, {}) : "";
    }
    /// The other end has closed.
    bool is_closed() {
        return test::wait_until([&] {
            boost::system::error_code error;
            std::string byte(100, '\0');
            socket.non_blocking(true);
            socket.read_some(asio::buffer(byte), error);
            return error && error != asio::error::would_block;
        });
    }

    tcp::socket socket;

  private:
    std::string heard_;
};

class IvyAgentTest : public testing::Test {
  protected:
    IvyAgentTest() {
        bus_socket.open(udp::v4());
        bus_socket.set_option(asio::socket_base::reuse_address(true));
        bus_socket.set_option(asio::socket_base::broadcast(true));
        bus_socket.bind({udp::v4(), port});
    }

    std::unique_ptr<MessageSource> open() { return open_ivy_bus(fmt::format("127:{}", port)); }

    void announce(const std::string& datagram) {
        bus_socket.send_to(asio::buffer(datagram), {asio::ip::make_address_v4("127.255.255.255"), port});
    }
    void announce() { announce(fmt::format("3 {} 77:1:77 Link\n", acceptor.local_endpoint().port())); }

    /// The words of the next announcement that is not the test's own.
    std::vector<std::string> hear_announcement() {
        for (;;) {
            if (!test::wait_until([&] { return bus_socket.available() > 0; })) return {};
            std::string datagram(1000, '\0');
            datagram.resize(bus_socket.receive(asio::buffer(datagram)));
            std::vector<std::string> words{""};
            for (const char c : datagram) {
                if (c == ' ' && words.size() < 4) {
                    words.emplace_back();
                } else {
                    words.back() += c;
                }
            }
            if (words.size() == 4 && words.back() != "Link\n" && words[0] == "3") return words;
        }
    }

    /// Connects to the agent that was announced, as others do.
    std::unique_ptr<Connection> connect() {
        auto connection = std::make_unique<Connection>(context);
        const auto words = hear_announcement();
        if (words.size() != 4) throw std::runtime_error("no announcement");
        connection->socket.connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(words[1]))});
        return connection;
    }

    std::unique_ptr<Connection> accept() {
        auto connection = std::make_unique<Connection>(context);
        acceptor.non_blocking(true);
        const bool accepted = test::wait_until([&] {
            boost::system::error_code error;
            acceptor.accept(connection->socket, error);
            return !error;
        });
        if (!accepted) throw std::runtime_error("no one connects");
        return connection;
    }

    /// What a source has when it has had so many messages.
    static std::vector<std::string> texts_of(MessageSource& source, std::size_t count) {
        std::vector<IncomingMessage> messages;
        test::wait_until([&] {
            source.receive(milliseconds(10), messages);
            return messages.size() >= count;
        });
        std::vector<std::string> texts;
        for (const auto& message : messages) texts.push_back(message.text);
        return texts;
    }

    const std::uint16_t port = test::free_udp_port();
    asio::io_context context;
    udp::socket bus_socket{context};
    tcp::acceptor acceptor{context, {asio::ip::address_v4::loopback(), 0}};
};

const std::string hello_end = "1 0\002(.*)\n5 0\002\n";

TEST_F(IvyAgentTest, AnnouncesItselfAndSaysWhatItSubscribesTo) {
    const auto source = open();
    const auto words = hear_announcement();
    ASSERT_EQ(words.size(), 4U);
    EXPECT_EQ(words[0], "3");
    EXPECT_EQ(words[3], "FlightWatt watch\n");
    EXPECT_THAT(words[2], testing::StartsWith("flightwatt:"));
    Connection peer(context);
    peer.socket.connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(words[1]))});
    EXPECT_EQ(peer.hear_until(hello_end), fmt::format("6 {}\002FlightWatt watch\n{}", words[1], hello_end));
    peer.send_bytes("6 4321\002Link\n1 0\002^(\\S*) WORLD\n5 0\002\n");
    peer.send_bytes("9 17\002\n");
    EXPECT_EQ(peer.hear_until("10 17"), "10 17\002\n");
    peer.send_bytes("2 0\00220 ENERGY 57 11.62\003\n2 0\002ground WIND 1\003\n");
    EXPECT_THAT(texts_of(*source, 2), ElementsAre("20 ENERGY 57 11.62", "ground WIND 1"));
}

TEST_F(IvyAgentTest, ConnectsWithThoseThatAnnounceThemselvesOnce) {
    const auto source = open();
    announce();
    announce();
    const auto peer = accept();
    EXPECT_THAT(peer->hear_until(hello_end), testing::EndsWith(hello_end));
    announce();
    peer->send_bytes("6 " + std::to_string(acceptor.local_endpoint().port()) +
                     "\002Link\n5 0\002\n2 0\002replay20 ENERGY 57\003\n2 0\002time20 13.9\003\n");
    std::vector<IncomingMessage> messages;
    ASSERT_TRUE(test::wait_until([&] {
        source->receive(milliseconds(10), messages);
        return !messages.empty();
    }));
    EXPECT_EQ(messages[0].text, "20 ENERGY 57");
    EXPECT_EQ(messages[0].time_s, 13.9);
    boost::system::error_code error;
    tcp::socket another(context);
    acceptor.accept(another, error);
    EXPECT_EQ(error, asio::error::would_block) << "it connected twice";
}

TEST_F(IvyAgentTest, OutlivesGarbageGoodByesAndAgentsThatVanish) {
    const auto source = open();
    announce(std::string("\x99\x05\x00\xff", 4));
    announce("4 2010 id other version\n");
    auto peer = connect();
    ASSERT_FALSE(peer->hear_until(hello_end).empty());
    peer->send_bytes("6 4321\002Link\n5 0\002\nnonsense\n\n\xff\xfe\002\n8 0\002\n42 0\002what\n" +
                     std::string(40'000, 'x'));
    peer->send_bytes("\n2 0\00220 EN");
    peer->send_bytes("ERGY 57\003\n");
    EXPECT_THAT(texts_of(*source, 1), ElementsAre("20 ENERGY 57"));
    peer->send_bytes("2 0\00220 CUT OFF IN THE MIDD");
    peer->socket.close();
    peer = connect();  // it announces itself again when it is alone
    ASSERT_FALSE(peer->hear_until(hello_end).empty());
    peer->send_bytes("6 4321\002Link\n5 0\002\n0 0\002\n");
    EXPECT_TRUE(peer->is_closed());
    peer = connect();
    peer->send_bytes("6 4321\002Link\n5 0\002\n2 0\00220 ALIVE 1\003\n");
    EXPECT_THAT(texts_of(*source, 1), ElementsAre("20 ALIVE 1"));
    const auto& report = source->report();
    EXPECT_EQ(report.restarts, 2U);
    EXPECT_EQ(report.unusable.at("lines that are not of the Ivy protocol"), 2U);
    EXPECT_EQ(report.unusable.at("Ivy lines of type 8, which are ignored"), 1U);
    EXPECT_EQ(report.unusable.at("Ivy lines of type 42, which are ignored"), 1U);
    EXPECT_EQ(report.unusable.at("lines longer than any message"), 1U);
    EXPECT_EQ(report.unusable.at("announcements that are not of the Ivy protocol, version 3"), 2U);
}

TEST_F(IvyAgentTest, KeepsOneOfTwoConnectionsWithAnAgentAsTheOtherDoes) {
    const auto source = open();
    auto outgoing = connect();  // the other heard of us
    announce();
    auto incoming = accept();  // and we of it
    const auto higher = [](const Connection& connection) {
        return std::max(connection.socket.local_endpoint().port(), connection.socket.remote_endpoint().port());
    };
    auto& kept = higher(*outgoing) > higher(*incoming) ? *incoming : *outgoing;
    const auto hello = fmt::format("6 {}\002Link\n5 0\002\n", acceptor.local_endpoint().port());
    outgoing->send_bytes(hello);
    ASSERT_FALSE(outgoing->hear_until(hello_end).empty());
    incoming->send_bytes(hello);
    auto& retired = &kept == incoming.get() ? *outgoing : *incoming;
    EXPECT_FALSE(retired.hear_until("0 0\002\n").empty());
    retired.send_bytes("2 0\00220 ALIVE 0\003\n0 0\002\n");  // what was sent before the other end knew still arrives
    EXPECT_THAT(texts_of(*source, 1), ElementsAre("20 ALIVE 0"));
    EXPECT_TRUE(retired.is_closed());
    kept.send_bytes("2 0\00220 ALIVE 1\003\n");
    EXPECT_THAT(texts_of(*source, 1), ElementsAre("20 ALIVE 1"));
}

TEST_F(IvyAgentTest, SaysGoodByeWhenItEnds) {
    auto source = open();
    auto peer = connect();
    ASSERT_FALSE(peer->hear_until(hello_end).empty());
    source.reset();
    EXPECT_EQ(peer->hear_until("\n"), "0 0\002\n");
    EXPECT_TRUE(peer->is_closed());
}

}  // namespace
}  // namespace flightwatt::live
