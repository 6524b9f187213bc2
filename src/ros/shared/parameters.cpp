#include "early_fusion/ros/shared/parameters.h"

#include <ros/names.h>
#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "early_fusion/core/error.h"
#include "early_fusion/core/number_text.h"

namespace early_fusion::nodes {

namespace {

/// roslaunch guesses types ("1" becomes an int, "true" a bool). An option parses text itself, so the value is converted
/// back to text.
std::string toText(XmlRpc::XmlRpcValue& value, const std::string& parameter) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string&>(value);
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int&>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return core::shortestText(static_cast<double&>(value));
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool&>(value) ? "true" : "false";
    default:
      throw core::Error(parameter + ": expected a single value, not a list or a group of parameters");
  }
}

}  // namespace

core::GivenOptions privateParameters(const core::OptionSet& options, const std::string& node) {
  core::GivenOptions parameters;
  XmlRpc::XmlRpcValue values;
  if (!::ros::param::get(node, values) || values.getType() != XmlRpc::XmlRpcValue::TypeStruct) return parameters;
  for (auto& [name, value] : values) {
    const bool is_group = value.getType() == XmlRpc::XmlRpcValue::TypeStruct;
    if (is_group && !options.has(name)) continue;
    parameters.emplace_back(name, toText(value, node + "/" + name));
  }
  return parameters;
}

void setFromParameters(core::OptionSet& options, const core::GivenOptions& parameters, const std::string& node) {
  for (const auto& [name, text] : parameters) options.set(name, text, node + "/" + name);
}

std::string describeParameters(const core::OptionSet& options) {
  std::string text;
  for (const core::Option& option : options.options()) {
    text += "  _" + option.name + ":=" + (option.initial.empty() ? "\"\"" : option.initial) + "  in " + option.range +
            (option.unit.empty() ? "" : " " + option.unit) + "\n      " + option.help + "\n";
  }
  return text;
}

}  // namespace early_fusion::nodes
