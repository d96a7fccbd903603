#pragma once

#include "live/predictor.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

namespace flightwatt::live {

/// What came in since the last look, in memory that is set aside once.
class InputBuffer {
  public:
    enum class Kind : std::uint8_t { line, message, frames, sample };

    explicit InputBuffer(std::size_t max_bytes) : bytes_(max_bytes) {}

    /// False where it does not fit.
    bool push(Kind kind, double time_s, std::string_view bytes) {
        const Head head{time_s, bytes.size(), kind};
        if (bytes.size() > bytes_.size() || used_ + sizeof(head) > bytes_.size() - bytes.size()) return false;
        std::memcpy(bytes_.data() + used_, &head, sizeof(head));
        if (!bytes.empty()) std::memcpy(bytes_.data() + used_ + sizeof(head), bytes.data(), bytes.size());
        used_ += sizeof(head) + bytes.size();
        return true;
    }

    bool push(const Sample& sample) {
        char bytes[sizeof(Sample)];
        std::memcpy(bytes, &sample, sizeof(sample));
        return push(Kind::sample, sample.time_s, {bytes, sizeof(bytes)});
    }

    static Sample sample_of(std::string_view bytes) {
        Sample sample;
        std::memcpy(&sample, bytes.data(), sizeof(sample));
        return sample;
    }

    /// Hands out all of it, in its order, and is empty.
    template <typename Visit>
    void take(const Visit& visit) {
        const auto end = used_;
        used_ = 0;
        for (std::size_t at = 0; at < end;) {
            Head head;
            std::memcpy(&head, bytes_.data() + at, sizeof(head));
            at += sizeof(head);
            visit(head.kind, head.time_s, std::string_view(bytes_.data() + at, head.size));
            at += head.size;
        }
    }

  private:
    struct Head {
        double time_s = 0.0;
        std::size_t size = 0;
        Kind kind = Kind::line;
    };
    static_assert(std::is_trivially_copyable_v<Sample> && std::is_trivially_copyable_v<Head>);

    std::vector<char> bytes_;
    std::size_t used_ = 0;
};

}  // namespace flightwatt::live
