#pragma once

#include "live/source.h"
#include "live/sources/followed_bytes.h"
#include "telemetry/link_decoder.h"

#include <filesystem>
#include <string>

namespace flightwatt::live {

/// A binary log that is being written: an SD card's, or a capture of a link. Its frames' own times count.
class BinaryLogSource : public MessageSource {
  public:
    BinaryLogSource(const std::filesystem::path& path, telemetry::MessageDictionary definitions);

    void receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) override;
    std::string description() const override { return "following " + followed_.path().string(); }
    const SourceReport& report() const override { return report_; }

  private:
    void restart_decoder(std::vector<IncomingMessage>& messages);
    void forward(const telemetry::LinkMessage& message, std::vector<IncomingMessage>& messages);
    void count();

    FileTail followed_;
    telemetry::MessageDictionary definitions_;
    telemetry::LinkDecoder decoder_;
    telemetry::LinkCounts counted_;
    SourceReport report_;
    bool restarted_ = false;
};

}  // namespace flightwatt::live
