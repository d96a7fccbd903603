#include "mechanical/covariate.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(Covariate, IsFoundByItsName) {
    for (const auto covariate : all_covariates) EXPECT_EQ(covariate_from(to_string(covariate)), covariate);
    EXPECT_FALSE(covariate_from("height"));
}

}  // namespace
}  // namespace flightwatt::mechanical
