#include "early_fusion/world/world.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "world/test_world.h"

namespace early_fusion::world {
namespace {

/// The error of loading the small world with one file changed.
std::string errorWith(const std::string& file, const std::string& text) {
  const TestFolder folder;
  const std::string world = writeTestWorld(folder);
  folder.write(file, text);
  return errorOf([&] { loadWorld(world); });
}

void expectError(const std::string& file, const std::string& text, const std::vector<std::string>& parts) {
  const std::string error = errorWith(file, text);
  for (const std::string& part : parts) EXPECT_NE(error.find(part), std::string::npos) << "'" << error << "'";
}

std::shared_ptr<const World> worldWithKitchen(const std::string& visuals) {
  const TestFolder folder;
  const std::string world = writeTestWorld(folder);
  folder.write("wedge.obj", boxObj(1, 2, 3));
  folder.write("kitchen.urdf",
               replaced(kKitchenUrdf, "<link name=\"world\"/>", "<link name=\"world\">" + visuals + "</link>"));
  return loadWorld(world);
}

/// Six times the volume that the triangles enclose: positive when they face outwards, and shared edges cancel.
double sixVolumes(const TexturedMesh& mesh) {
  double sum = 0;
  for (const MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      const auto at = [&](int k) -> Eigen::Vector3d {
        return part.vertices[part.indices[i + k]].position.cast<double>();
      };
      sum += at(0).dot(at(1).cross(at(2)));
    }
  }
  return sum;
}

TEST(World, HoldsWhatItsFilesSay) {
  const auto world = testWorld();
  EXPECT_EQ(world->objects.size(), 4);
  EXPECT_EQ(world->rig.lattice().panCount(), 41);
  EXPECT_EQ(world->options.clearance, 0.005);
  ASSERT_EQ(world->kitchen.size(), 1u);
  EXPECT_EQ(world->kitchen[0].link, "counter");
  EXPECT_TRUE(world->kitchen[0].world_from_mesh.translation().isApprox(Eigen::Vector3d(0.825, 0, 0.88), 1e-9));
}

TEST(World, PlacesObjectsAboutTheMiddleOfTheCountersTop) {
  const HorizontalRectangle area = testWorld()->placement;
  EXPECT_NEAR(area.min_x, 0.575, 1e-9);
  EXPECT_NEAR(area.max_x, 1.075, 1e-9);
  EXPECT_NEAR(area.min_y, -0.6, 1e-9);
  EXPECT_NEAR(area.max_y, 0.6, 1e-9);
  EXPECT_NEAR(area.z, 0.9, 1e-9);
}

TEST(World, ReadsACounterThatIsTurnedAQuarter) {
  const TestFolder folder;
  const std::string world = writeTestWorld(folder);
  const std::string level = R"(<collision><origin xyz="0 0 0.88"/><geometry><box size="0.75 3.2 0.04"/>)";
  const std::string turned =
      R"(<collision><origin xyz="0 0 0.88" rpy="0 0 1.570796"/><geometry><box size="3.2 0.75 0.04"/>)";
  folder.write("kitchen.urdf", replaced(kKitchenUrdf, level, turned));
  const HorizontalRectangle area = loadWorld(world)->placement;
  EXPECT_NEAR(area.min_x, 0.575, 1e-4);
  EXPECT_NEAR(area.max_y, 0.6, 1e-4);
}

TEST(World, RefusesAShapeThatIsUnknownOrHasNoSize) {
  for (const char* shape : {R"(<capsule radius="0.1" length="0.2"/>)", R"(<box size="0.1 0.1"/>)", "",
                            R"(<box size="-0.1 0.1 0.1"/>)", R"(<sphere radius="0"/>)"}) {
    const std::string collision = std::string("<collision><geometry>") + shape + "</geometry></collision>";
    const std::string error = errorOf([&] { worldWithKitchen(collision); });
    EXPECT_NE(error.find("kitchen.urdf: "), std::string::npos) << shape << ": " << error;
    EXPECT_NE(error.find("positive"), std::string::npos) << shape << ": " << error;
  }
}

TEST(World, TurnsShapesIntoClosedMeshesOfTheirColour) {
  const auto world = worldWithKitchen(R"(
    <visual><geometry><box size="1 2 3"/></geometry><material name="wood"/></visual>
    <visual><geometry><cylinder radius="0.5" length="2"/></geometry></visual>
    <visual><geometry><sphere radius="0.5"/></geometry></visual>)");
  ASSERT_EQ(world->kitchen.size(), 4u);  // links in the order of their names: counter, world
  EXPECT_EQ(world->kitchen[1].mesh.parts[0].texture.texels.at(0), 0xff336699u) << "0.6 0.4 0.2, red in the low byte";
  EXPECT_NEAR(sixVolumes(world->kitchen[1].mesh) / 6, 6, 1e-5);
  const double cylinder = M_PI * 0.25 * 2, ball = M_PI / 6;
  EXPECT_NEAR(sixVolumes(world->kitchen[2].mesh) / 6, cylinder, 0.01 * cylinder);
  EXPECT_NEAR(sixVolumes(world->kitchen[3].mesh) / 6, ball, 0.03 * ball);
  EXPECT_TRUE(world->kitchen[2].mesh.bounds().sizes().isApprox(Eigen::Vector3f(1, 1, 2), 1e-5f));
}

TEST(World, LoadsMeshesRelativeToTheUrdfByUrlAndFromThePackage) {
  const TestFolder elsewhere;
  const std::string slab = elsewhere.write("slab.obj", boxObj(4, 5, 0.1));
  const auto world = worldWithKitchen(R"(
    <visual><origin xyz="0 0 1" rpy="0 0 1.570796"/><geometry><mesh filename="wedge.obj" scale="1 1 0.5"/></geometry></visual>
    <visual><geometry><mesh filename="package://early_fusion/meshes/kitchen/counter.obj"/></geometry></visual>
    <visual><geometry><mesh filename="file://)" +
                                      slab + R"("/></geometry></visual>)");
  ASSERT_EQ(world->kitchen.size(), 4u);
  EXPECT_TRUE(world->kitchen[3].mesh.bounds().sizes().isApprox(Eigen::Vector3f(4, 5, 0.1f), 1e-5f));
  EXPECT_TRUE(world->kitchen[1].mesh.bounds().sizes().isApprox(Eigen::Vector3f(1, 2, 1.5), 1e-5f));
  EXPECT_NEAR(world->kitchen[1].world_from_mesh.translation().z(), 1, 1e-9);
  EXPECT_GT(world->kitchen[2].mesh.triangleCount(), 2u);
}

TEST(World, OfThePackageHoldsSixteenObjectsOnTheCounter) {
  const auto world = loadWorld("");
  EXPECT_EQ(world->objects.size(), 16);
  EXPECT_NEAR(world->placement.z, 0.9, 1e-9);
  EXPECT_GE(world->placement.min_x, 0.45);
  EXPECT_LE(world->placement.max_x, 1.2);
  EXPECT_GT(world->kitchen.size(), 4u);
}

TEST(World, TheShippedFileHoldsEveryDefault) {
  const std::string file = core::shareFolder() + "/config/world.yaml";
  WorldOptions shipped, defaults;
  shipped.options().setFromYamlFile(file);
  EXPECT_EQ(shipped.options().toYaml(), defaults.options().toYaml());
  EXPECT_EQ(core::loadYamlFile(file).size(), defaults.options().options().size()) << "not every key is there";
}

TEST(World, FindsTheUrdfsOfAFileRelativeToIt) {
  const TestFolder folder;
  const std::string file = folder.write("mine.yaml", "{camera_urdf: robots/neck.urdf, kitchen_urdf: /room.urdf}");
  EXPECT_EQ(findUrdfs(file).camera, folder.path() + "/robots/neck.urdf");
  EXPECT_EQ(findUrdfs(file).kitchen, "/room.urdf");
  EXPECT_EQ(findUrdfs("").camera, core::shareFolder() + "/urdf/pan_tilt_camera.urdf");
  EXPECT_EQ(errorOf([&] { findUrdfs(folder.write("bad.yaml", "camera: x")); }).rfind(folder.path() + "/bad.yaml:1", 0),
            0u);
}

TEST(World, NamesTheKeyOfAMistake) {
  expectError("world.yaml", std::string(kWorldYaml) + "colour: red\n", {"world.yaml", "colour"});
  expectError("world.yaml", std::string(kWorldYaml) + "clearance: wide\n", {"world.yaml", "clearance", "wide"});
  expectError("world.yaml", std::string(kWorldYaml) + "image_size: 100\n",
              {"world.yaml", "image_size: '100'", "a multiple of 16"});
  expectError("world.yaml", std::string(kWorldYaml) + "horizontal_fov_deg: 180\n", {"horizontal_fov_deg", "180"});
  expectError("world.yaml", std::string(kWorldYaml) + "pan_joint: neck\n", {"rig.urdf", "no joint 'neck'"});
  EXPECT_NE(errorOf([] { loadWorld("/no/such/world.yaml"); }).find("/no/such/world.yaml"), std::string::npos);
}

TEST(World, RefusesACounterThatIsTooSmall) {
  expectError("world.yaml", replaced(kWorldYaml, "placement_width: 1.2", "placement_width: 3.3"),
              {"world.yaml", "placement_width is 3.3 m", "only 3.2 m"});
  expectError("world.yaml", replaced(kWorldYaml, "placement_depth: 0.5", "placement_depth: 0.8"),
              {"world.yaml", "placement_depth is 0.8 m", "only 0.75 m"});
}

TEST(World, SaysWhatIsWrongWithTheKitchen) {
  expectError("kitchen.urdf", "<robot/>", {"kitchen.urdf", "not a valid URDF"});
  expectError("world.yaml", std::string(kWorldYaml) + "counter_link: table\n",
              {"kitchen.urdf", "no link 'table'", "counter, world"});
  expectError("kitchen.urdf",
              replaced(kKitchenUrdf, R"(<joint name="counter_joint" type="fixed">)",
                       R"(<joint name="counter_joint" type="floating">)"),
              {"kitchen.urdf", "joint 'counter_joint' must be fixed"});
  expectError("kitchen.urdf",
              replaced(kKitchenUrdf, "<collision>", "<collision name='top'><!-- none --></collision><collision>"),
              {"kitchen.urdf"});
  const std::string box =
      R"(<collision><origin xyz="0 0 0.88"/><geometry><box size="0.75 3.2 0.04"/></geometry></collision>)";
  expectError("kitchen.urdf", replaced(kKitchenUrdf, box, ""), {"link 'counter' needs a collision box"});
  expectError("kitchen.urdf",
              replaced(kKitchenUrdf, box, replaced(box, R"(<box size="0.75 3.2 0.04"/>)", R"(<sphere radius="1"/>)")),
              {"link 'counter' needs a collision box"});
  expectError("kitchen.urdf",
              replaced(kKitchenUrdf, box, replaced(box, R"(xyz="0 0 0.88")", R"(xyz="0 0 0.88" rpy="0.1 0 0")")),
              {"link 'counter'", "parallel to the world's axes"});
}

TEST(World, SaysWhichMeshOfTheKitchenIsMissing) {
  const auto with_mesh = [](const std::string& name) {
    return replaced(kKitchenUrdf, R"(<box size="0.75 3.2 0.04"/></geometry><material)",
                    "<mesh filename=\"" + name + "\"/></geometry><material");
  };
  expectError("kitchen.urdf", with_mesh("none.obj"), {"kitchen.urdf: link 'counter'", "none.obj"});
  expectError("kitchen.urdf", with_mesh("package://another/none.obj"),
              {"kitchen.urdf: link 'counter'", "package://another/none.obj", "ROS_PACKAGE_PATH"});
}

}  // namespace
}  // namespace early_fusion::world
