#include "early_fusion/ros/policy/request_pairing.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

namespace early_fusion::nodes {
namespace {

constexpr std::size_t kManyBytes = 1 << 20;

template <class Message>
boost::shared_ptr<const Message> stamped(double stamp_sec, int seq) {
  const auto message = boost::make_shared<Message>();
  message->header.stamp = ::ros::Time(stamp_sec);
  message->header.seq = seq;
  return message;
}

const auto image = stamped<sensor_msgs::Image>;
const auto request = stamped<Request>;

TEST(RequestPairing, EitherOfAPairMayComeFirst) {
  RequestPairing pairing(30, kManyBytes);
  EXPECT_FALSE(pairing.add(image(1, 0)));
  EXPECT_FALSE(pairing.add(image(2, 0)));
  const auto first = pairing.add(request(2, 0));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->first->header.stamp, ::ros::Time(2));
  EXPECT_FALSE(pairing.add(request(3, 0)));
  EXPECT_FALSE(pairing.add(image(2.5, 0)));
  const auto second = pairing.add(image(3, 0));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->second->header.stamp, ::ros::Time(3));
}

TEST(RequestPairing, APairUsesUpWhatCameBefore) {
  RequestPairing pairing(30, kManyBytes);
  pairing.add(image(1, 0));
  pairing.add(image(2, 0));
  ASSERT_TRUE(pairing.add(request(2, 0)));
  EXPECT_FALSE(pairing.add(request(1, 0)));
  EXPECT_FALSE(pairing.add(request(2, 0)));
  EXPECT_TRUE(pairing.add(image(2, 0))) << "a step that is published again";
}

TEST(RequestPairing, GoesOnWhenTheStampsJumpBack) {
  RequestPairing pairing(3, kManyBytes);
  for (int i = 0; i < 10; ++i) pairing.add(image(100 + i, 0));
  for (int i = 0; i < 10; ++i) {
    pairing.add(image(1 + i, 0));
    EXPECT_TRUE(pairing.add(request(1 + i, 0))) << i;
  }
}

TEST(RequestPairing, WithEqualStampsARequestGetsTheNewestImage) {
  RequestPairing pairing(30, kManyBytes);
  for (int step = 0; step < 3; ++step) {
    pairing.add(image(0, 10 * step));
    pairing.add(image(0, 10 * step + 1));
    const auto pair = pairing.add(request(0, step));
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->first->header.seq, 10u * step + 1);
  }
}

TEST(RequestPairing, ForgetsImagesBeyondItsCapacity) {
  RequestPairing pairing(3, kManyBytes);
  for (int i = 0; i < 4; ++i) pairing.add(image(i, 0));
  EXPECT_FALSE(pairing.add(request(0, 0)));
  EXPECT_TRUE(pairing.add(request(1, 0)));
}

TEST(RequestPairing, OfLargeImagesKeepsWhatFitsButAtLeastThree) {
  const auto large = [](double stamp_sec) {
    const auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = ::ros::Time(stamp_sec);
    image->data.resize(1000);
    return sensor_msgs::ImageConstPtr(image);
  };
  RequestPairing fits(30, 5500);
  for (int i = 0; i < 10; ++i) fits.add(large(i));
  EXPECT_FALSE(fits.add(request(4, 0)));
  EXPECT_TRUE(fits.add(request(5, 0))) << "five images have 5000 bytes";
  RequestPairing small(30, 10);
  for (int i = 0; i < 10; ++i) small.add(large(i));
  EXPECT_FALSE(small.add(request(6, 0)));
  EXPECT_TRUE(small.add(request(7, 0)));
}

}  // namespace
}  // namespace early_fusion::nodes
