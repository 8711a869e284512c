#include "api/formats/text_numbers.hpp"

#include <gtest/gtest.h>

namespace symcell {
namespace {

TEST(TextNumbers, FiniteOnes) {
  for (const auto& [token, value] : {std::pair{"1", 1.0},
                                     {"-2.5", -2.5},
                                     {"+3", 3.0},
                                     {"1e-3", 1e-3},
                                     {"1E5", 1e5},
                                     {".5", 0.5},
                                     {"1e-999", 0.0},
                                     {"-0.0001e-400", 0.0},
                                     {"123e-340", 0.0}}) {
    const ParsedNumber number = parse_number(token);
    EXPECT_EQ(number.kind, NumberKind::kFinite) << token;
    EXPECT_EQ(number.value, value) << token;
  }
}

TEST(TextNumbers, OnesThatAreNotFinite) {
  for (const char* token :
       {"1e999", "-1e999", "nan", "inf", "-inf", "0.001e400", "1e99999999999999999999"}) {
    EXPECT_EQ(parse_number(token).kind, NumberKind::kNonFinite) << token;
  }
  EXPECT_EQ(parse_number(std::string(400, '9')).kind, NumberKind::kNonFinite);
}

TEST(TextNumbers, TextThatIsNone) {
  for (const char* token : {"", "x", "1x", "1,5", "+-1", "--1", "0x10", " 1"}) {
    EXPECT_EQ(parse_number(token).kind, NumberKind::kNoNumber) << token;
  }
  EXPECT_FALSE(parse_integer("1.0"));
  EXPECT_FALSE(parse_integer("99999999999999999999"));
  EXPECT_EQ(parse_integer("-7"), -7);
}

TEST(TextNumbers, WholeOnes) {
  EXPECT_EQ(whole_int32(2.0), 2);
  EXPECT_EQ(whole_int32(-2147483648.0), -2147483647 - 1);
  EXPECT_FALSE(whole_int32(2.5));
  EXPECT_FALSE(whole_int32(3e9));
  EXPECT_FALSE(whole_int32(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace symcell
