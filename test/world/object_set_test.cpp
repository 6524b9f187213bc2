#include "early_fusion/world/object_set.h"

#include <gtest/gtest.h>

#include "world/test_world.h"

namespace early_fusion::world {
namespace {

ObjectSet load(const std::string& yaml) {
  const TestFolder folder;
  writeTestWorld(folder);
  return ObjectSet::load(folder.write("objects.yaml", yaml), 2000);
}

void expectError(const std::string& yaml, const std::vector<std::string>& parts) {
  const std::string error = errorOf([&] { load(yaml); });
  for (const std::string& part : parts)
    EXPECT_NE(error.find(part), std::string::npos) << "'" << error << "' of " << yaml;
}

void expectBounds(const Object& object, double x, double y, double z) {
  const Eigen::AlignedBox3f bounds = object.mesh.bounds();
  EXPECT_LT((bounds.min() - Eigen::Vector3f(-x / 2, -y / 2, 0)).norm(), 1e-6f) << object.name;
  EXPECT_LT((bounds.max() - Eigen::Vector3f(x / 2, y / 2, z)).norm(), 1e-6f) << object.name;
  Eigen::AlignedBox3d hull;
  for (const Eigen::Vector3d& corner : object.hull) hull.extend(corner);
  EXPECT_LT((hull.min() - bounds.min().cast<double>()).norm(), 1e-6) << object.name;
  EXPECT_LT((hull.max() - bounds.max().cast<double>()).norm(), 1e-6) << object.name;
}

TEST(ObjectSet, StandsScaledMeshesUprightAndCentred) {
  const ObjectSet set = load(kObjectsYaml);
  ASSERT_EQ(set.size(), 4);
  expectBounds(set[0], 0.06, 0.16, 0.21);
  expectBounds(set[2], 0.057, 0.057, 0.057);  // millimetres, not on z = 0 in the file
  const double diameter = 2 * 0.12 * std::cos(M_PI / 24);
  expectBounds(set[3], diameter, diameter, 0.02);  // scaled along x and y alone
}

TEST(ObjectSet, CentresAMeshThatLiesOffItsOrigin) {
  const TestFolder folder;
  folder.write("off.obj", "v 1 2 3\nv 1.1 2 3\nv 1 2.2 3\nv 1 2 3.3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const ObjectSet set = ObjectSet::load(folder.write("objects.yaml", "objects: [{name: off, mesh: off.obj}]\n"), 2000);
  expectBounds(set[0], 0.1, 0.2, 0.3);
  EXPECT_EQ(set[0].hull.size(), 4u);
}

TEST(ObjectSet, NamesItsItemsInTheOrderOfTheFile) {
  EXPECT_EQ(load(kObjectsYaml).vocabulary().names(), (std::vector<std::string>{"box", "can", "cube", "plate"}));
}

TEST(ObjectSet, HullsHaveTheirMeshesCornersAndAreFewEnoughToBeQuick) {
  const ObjectSet set = load(kObjectsYaml);
  EXPECT_EQ(set[0].hull.size(), 8u);
  EXPECT_EQ(set[1].hull.size(), 32u);
  const ObjectSet shipped = ObjectSet::load(core::shareFolder() + "/config/objects.yaml", 2000);
  EXPECT_EQ(shipped.size(), 16);
  for (int i = 0; i < shipped.size(); ++i) {
    EXPECT_LE(shipped[i].hull.size(), 300u) << shipped[i].name;
    EXPECT_GE(shipped[i].hull.size(), 8u) << shipped[i].name;
  }
}

TEST(ObjectSet, NamesFileLineAndKeyOfAMistake) {
  expectError("objects: [", {"objects.yaml:1", "not valid YAML"});
  expectError("things: []\n", {"objects.yaml: needs 'objects'"});
  expectError("objects: []\n", {"objects.yaml: needs 'objects'"});
  expectError("[]", {"objects.yaml: needs 'objects'"});
  expectError("objects:\n  - {name: box, mesh: box.obj}\nsize: 2\n", {"objects.yaml:3", "unknown key 'size'"});
  expectError("objects:\n  - box\n", {"objects.yaml:2", "a map"});
  expectError("objects:\n  - {mesh: box.obj}\n", {"objects.yaml:2", "needs a name"});
  expectError("objects:\n  - {name: box}\n", {"objects.yaml:2", "needs a mesh"});
  expectError("objects:\n  - {name: box, mesh: [box.obj]}\n", {"objects.yaml:2", "needs a mesh"});
  expectError("objects:\n  - {name: box, mesh: box.obj, size: 2}\n",
              {"objects.yaml:2", "unknown key 'size'", "mesh, name, rotation, scale"});
  expectError("objects:\n  - {name: box, mesh: box.obj, name: can}\n", {"objects.yaml:2", "name is given twice"});
  expectError("objects:\n  - {name: box, mesh: box.obj}\nobjects: []\n", {"objects.yaml:3", "objects is given twice"});
  expectError("objects:\n  - {name: box, mesh: none.obj}\n", {"objects.yaml:2", "object 'box'", "none.obj"});
  expectError("objects:\n  - {name: box, mesh: box.obj}\n  - {name: box, mesh: can.obj}\n",
              {"objects.yaml", "'box' is listed twice"});
}

TEST(ObjectSet, RefusesAScaleThatIsNone) {
  for (const char* scale : {"0", "-1", "big", "[1, 2]", "[1, 1, 0]", "[1, 1, x]", "{x: 1}", ".nan", ".inf"}) {
    expectError("objects:\n  - {name: box, mesh: box.obj, scale: " + std::string(scale) + "}\n",
                {"objects.yaml:2", "scale is '"});
  }
}

TEST(ObjectSet, TurnsAMeshAsTheFileSays) {
  const TestFolder folder;
  folder.write("off.obj", "v 1 2 3\nv 1.1 2 3\nv 1 2.2 3\nv 1 2 3.3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const auto load = [&](const std::string& rotation) {
    return ObjectSet::load(
        folder.write("objects.yaml", "objects: [{name: off, mesh: off.obj, rotation: " + rotation + "}]\n"), 2000);
  };
  expectBounds(load("[90, 0, 0]")[0], 0.1, 0.3, 0.2);
  expectBounds(load("[90, 0, 90]")[0], 0.3, 0.1, 0.2);  // about the fixed x axis, then about the fixed z axis
  const Object object = load("[30, 40, 50]")[0];
  const Eigen::Vector3d corner = object.mesh_rotation * Eigen::Vector3d(1.1, 2, 3) - object.mesh_origin;
  bool found = false;
  for (const Vertex& vertex : object.mesh.parts[0].vertices)
    found |= (vertex.position.cast<double>() - corner).norm() < 1e-6;
  EXPECT_TRUE(found);
  for (const std::string bad : {"[90, 0]", "90", "[a, 0, 0]", "[400, 0, 0]", "[.nan, 0, 0]", "{x: 1}"}) {
    const std::string error = errorOf([&] { load(bad); });
    EXPECT_NE(error.find("objects.yaml:1: rotation is '"), std::string::npos) << error;
  }
}

TEST(ObjectSet, RefusesAMeshInAnotherUnit) {
  expectError("objects:\n  - {name: cube, mesh: cube.obj}\n",
              {"objects.yaml:2", "object 'cube'", "57 x 57 x 57 m", "check the scale"});
}

TEST(ObjectSet, RefusesAFlatMesh) {
  const TestFolder folder;
  folder.write("flat.obj", "v 0 0 0\nv 0.06 0 0\nv 0.06 0.06 0\nv 0 0.06 0\nf 1 2 3 4\n");
  const std::string yaml = folder.write("objects.yaml", "objects: [{name: card, mesh: flat.obj}]\n");
  const std::string error = errorOf([&] { ObjectSet::load(yaml, 2000); });
  EXPECT_NE(error.find("object 'card'"), std::string::npos) << error;
  EXPECT_NE(error.find("the mesh is flat"), std::string::npos) << error;
}

}  // namespace
}  // namespace early_fusion::world
