// Decoding takes memory at its beginning, and none for a frame: a link may be listened to for days.

#include "helpers/binary_definitions.h"
#include "helpers/binary_frames.h"
#include "telemetry/link_decoder.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <new>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

// Of this whole test program. GCC does not see that they belong together.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void* operator new(std::size_t size) {
    ++allocations;
    if (void* const memory = std::malloc(std::max<std::size_t>(size, 1))) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t& /*nothrow*/) noexcept {
    ++allocations;
    return std::malloc(std::max<std::size_t>(size, 1));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t& /*nothrow*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

namespace flightwatt::telemetry {
namespace {

std::string some_frames(Framing framing, LinkVersion version, const MessageDictionary& dictionary) {
    std::string bytes;
    for (int i = 0; i < 100; ++i) {
        for (const auto& text : {fmt::format("7 ENERGY {} 11.62 1.64 19.1 0.08 {}.", i, i),
                                 fmt::format("7 ARRAYS 1,{},153 1.5,-3.,{}. \"xyz\" \"ab\" 126,153", i, i)}) {
            const auto message = test::binary_message(text, dictionary, version).value();
            if (framing == Framing::card) bytes += test::card_frame(message, 400'000 + 500U * static_cast<unsigned>(i));
            if (framing == Framing::link) bytes += test::link_frame(message);
            if (framing == Framing::xbee) bytes += test::xbee_frame(message, 0x81, i % 2 == 0);
        }
        if (i % 10 == 0) bytes += "damaged";
    }
    return bytes;
}

TEST(LinkDecoder, AllocatesNothingForAFrame) {
    const auto dictionary = test::binary_dictionary();
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) {
        for (const auto version : {LinkVersion::v1, LinkVersion::v2}) {
            SCOPED_TRACE(fmt::format("{}, {}", to_string(framing), to_string(version)));
            const auto bytes = some_frames(framing, version, dictionary);
            LinkDecoder decoder(dictionary, framing, version);
            std::size_t messages = 0;
            const std::function<void(const LinkMessage&)> sink = [&](const LinkMessage&) { ++messages; };
            decoder.push(bytes, sink);  // room for the longest
            const auto before = allocations.load();
            for (int i = 0; i < 5; ++i) decoder.push(bytes, sink);
            EXPECT_EQ(allocations.load(), before);
            EXPECT_GT(messages, 1100u);
        }
    }
    EXPECT_GT(allocations.load(), 0u) << "they are counted";
}

}  // namespace
}  // namespace flightwatt::telemetry
