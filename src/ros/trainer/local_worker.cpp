#include "early_fusion/ros/trainer/local_worker.h"

#include <omp.h>

#include <boost/make_shared.hpp>
#include <exception>

#include "early_fusion/ros/shared/parameters.h"

namespace early_fusion::nodes {

namespace {

constexpr double kStopCheckSec = 0.1;

/// Throws an exception of another thread in the thread that spins the process's own queue.
class Rethrow : public ::ros::CallbackInterface {
 public:
  explicit Rethrow(std::exception_ptr exception) : exception_(std::move(exception)) {}
  CallResult call() override { std::rethrow_exception(exception_); }

 private:
  std::exception_ptr exception_;
};

}  // namespace

LocalWorker::LocalWorker(const std::string& name_space, std::shared_ptr<const world::World> world, int threads) {
  ::ros::NodeHandle node(name_space);
  node.setCallbackQueue(&queue_);
  const NodeContext simulator{node, node.resolveName("simulator")}, policy{node, node.resolveName("policy")};
  policy_ = std::make_unique<PolicyNode>(optionsOf<PolicyNode>(policy.name), policy);
  simulator_ = std::make_unique<SimulatorNode>(optionsOf<SimulatorNode>(simulator.name), simulator, std::move(world));
  thread_ = std::thread([this, threads] { spin(threads); });
}

LocalWorker::~LocalWorker() {
  stop_ = true;
  thread_.join();
}

void LocalWorker::spin(int threads) {
  if (threads > 0) omp_set_num_threads(threads);  // of this thread's parallel loops
  try {
    while (!stop_) queue_.callAvailable(::ros::WallDuration(kStopCheckSec));
  } catch (...) {
    ::ros::getGlobalCallbackQueue()->addCallback(boost::make_shared<Rethrow>(std::current_exception()));
  }
}

}  // namespace early_fusion::nodes
