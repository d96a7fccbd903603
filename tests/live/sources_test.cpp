#include "live/sources.h"

#include "base/error.h"

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

TEST(Sources, RefuseWhatIsNoBus) {
    EXPECT_THROW(open_ivy_bus("somewhere"), UsageError);
}

}  // namespace
}  // namespace flightwatt::live
