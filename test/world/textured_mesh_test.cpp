#include "early_fusion/world/textured_mesh.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "early_fusion/core/random.h"
#include "world/handmade_world.h"
#include "world/test_world.h"
#include "world/ycb_scans.h"

namespace early_fusion::world {
namespace {

const Eigen::Affine3d kUnscaled = Eigen::Affine3d::Identity();
constexpr int kManyTriangles = 100000;

class TexturedMeshTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }

  /// Red in the upper left quarter, else blue.
  void writeImage(const std::string& name, int width, int height) const {
    cv::Mat image(height, width, CV_8UC3, cv::Scalar(200, 0, 0));
    image(cv::Rect(0, 0, width / 2, height / 2)) = cv::Scalar(0, 0, 200);
    ASSERT_TRUE(cv::imwrite(folder_.path() + "/" + name, image));
  }

  /// Loads a mesh. @return what is said on stderr.
  static std::string notesOf(const std::string& path, TexturedMesh* mesh = nullptr,
                             int max_triangles = kManyTriangles) {
    testing::internal::CaptureStderr();
    const TexturedMesh loaded = loadTexturedMesh(path, kUnscaled, max_triangles);
    if (mesh != nullptr) *mesh = loaded;
    return testing::internal::GetCapturedStderr();
  }

  static std::string errorOf(const std::string& path) {
    return world::errorOf([&] { loadTexturedMesh(path, kUnscaled, kManyTriangles); });
  }

  const TestFolder folder_;
};

const char* const kSquare =
    "mtllib square.mtl\n"
    "v 0 0 0\nv 2 0 0\nv 2 0 1\nv 0 0 1\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl cloth\nf 1/1 2/2 3/3 4/4\n";

/// A ball as an OBJ file, without normals.
std::string ballObj(int segments, int rings) {
  MeshPart part;
  appendBall(part, 0.05f, 0.1f, segments, rings);
  std::ostringstream text;
  for (const Vertex& v : part.vertices) {
    text << "v " << v.position.x() << ' ' << v.position.y() << ' ' << v.position.z() << "\nvt " << v.uv.x() << ' '
         << v.uv.y() << '\n';
  }
  for (std::size_t i = 0; i < part.indices.size(); ++i) {
    text << (i % 3 == 0 ? "\nf " : " ") << part.indices[i] + 1 << '/' << part.indices[i] + 1;
  }
  return text.str() + "\n";
}

TEST_F(TexturedMeshTest, ReadsTriangledPolygonsWithTheirTexture) {
  writeImage("cloth.png", 64, 64);
  write("square.mtl", "newmtl cloth\nKd 1 1 1\nKs 0.4 0.4 0.4\nNs 60\nmap_Kd cloth.png\n");
  const TexturedMesh mesh =
      loadTexturedMesh(write("square.obj", kSquare), Eigen::Affine3d(Eigen::Scaling(1., 1., 0.5)), kManyTriangles);
  ASSERT_EQ(mesh.parts.size(), 1u);
  const MeshPart& part = mesh.parts[0];
  EXPECT_EQ(mesh.triangleCount(), 2u);
  EXPECT_TRUE(mesh.bounds().min().isApprox(Eigen::Vector3f(0, 0, 0)));
  EXPECT_TRUE(mesh.bounds().max().isApprox(Eigen::Vector3f(2, 0, 0.5f)));
  EXPECT_NEAR(part.specular, 0.4, 1e-6);
  ASSERT_EQ(part.texture.size, 64);
  EXPECT_EQ(part.texture.texels[5 * 64 + 5], rgb(200, 0, 0));
  EXPECT_EQ(part.texture.texels[60 * 64 + 5], rgb(0, 0, 200));
  for (const Vertex& vertex : part.vertices) {
    EXPECT_TRUE(vertex.normal.isApprox(-Eigen::Vector3f::UnitY())) << "not outwards";
    // v grows downwards: the top of the square has the image's first row.
    EXPECT_FLOAT_EQ(vertex.uv.y(), vertex.position.z() > 0.1f ? 0.f : 1.f);
    EXPECT_FLOAT_EQ(vertex.uv.x(), vertex.position.x() / 2);
  }
}

TEST_F(TexturedMeshTest, TexturesBecomeSquaresOfAPowerOfTwo) {
  write("square.mtl", "newmtl cloth\nmap_Kd cloth.png\n");
  const std::string path = write("square.obj", kSquare);
  const struct { int width, height, size; } cases[] = {{100, 60, 128}, {2048, 1024, 512}, {3, 3, 4}, {256, 256, 256}};
  for (const auto& c : cases) {
    writeImage("cloth.png", c.width, c.height);
    const Texture texture = loadTexturedMesh(path, kUnscaled, kManyTriangles).parts[0].texture;
    EXPECT_EQ(texture.size, c.size);
    EXPECT_EQ(texture.texels.size(), static_cast<std::size_t>(c.size) * c.size);
    EXPECT_EQ(texture.texels.front(), rgb(200, 0, 0));
    EXPECT_EQ(texture.texels.back(), rgb(0, 0, 200));
  }
}

TEST_F(TexturedMeshTest, APlainColourBecomesASmallTexture) {
  write("square.mtl", "newmtl cloth\nKd 1 0.5 0\n");
  const TexturedMesh mesh = loadTexturedMesh(write("square.obj", kSquare), kUnscaled, kManyTriangles);
  EXPECT_FALSE(mesh.adapted);
  const MeshPart& part = mesh.parts[0];
  EXPECT_EQ(part.texture.size, 4);
  EXPECT_EQ(part.texture.texels, std::vector<std::uint32_t>(16, rgb(255, 128, 0)));
  EXPECT_EQ(part.specular, 0.f);
}

TEST_F(TexturedMeshTest, EveryMaterialIsAPart) {
  write("square.mtl", "newmtl cloth\nKd 1 0 0\nnewmtl wood\nKd 0 1 0\n");
  const std::string text = std::string(kSquare) + "v 0 1 0\nv 2 1 0\nv 2 1 1\nusemtl wood\nf 5/1 6/2 7/3\n";
  const TexturedMesh mesh = loadTexturedMesh(write("two.obj", text), kUnscaled, kManyTriangles);
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.parts[0].texture.texels[0], rgb(255, 0, 0));
  EXPECT_EQ(mesh.parts[0].indices.size(), 6u);
  EXPECT_EQ(mesh.parts[1].texture.texels[0], rgb(0, 255, 0));
  EXPECT_EQ(mesh.parts[1].indices.size(), 3u);
}

TEST_F(TexturedMeshTest, SmoothNormalsAreMadeWhereTheFileHasNone) {
  const TexturedMesh mesh = loadTexturedMesh(write("ball.obj", ballObj(24, 12)), kUnscaled, kManyTriangles);
  for (const Vertex& vertex : mesh.parts.at(0).vertices) {
    const Eigen::Vector3f outwards = (vertex.position - Eigen::Vector3f(0, 0, 0.05f)).normalized();
    EXPECT_GT(vertex.normal.dot(outwards), 0.95f);
    EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
  }
}

TEST_F(TexturedMeshTest, NodesAreMovedAndMirroredOnesStayOutside) {
  // Two instances of one triangle: one moved, one mirrored; a Collada file keeps them as nodes.
  const std::string source =
      "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
      "<asset><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh>"
      "<source id=\"p\"><float_array id=\"pa\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array><technique_common>"
      "<accessor source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
      "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
      "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
      "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles>"
      "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">"
      "<node id=\"a\"><translate>0 0 5</translate><instance_geometry url=\"#g\"/></node>"
      "<node id=\"b\"><scale>-1 1 1</scale><instance_geometry url=\"#g\"/></node>"
      "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
  const TexturedMesh mesh = loadTexturedMesh(write("nodes.dae", source), kUnscaled, kManyTriangles);
  EXPECT_EQ(mesh.triangleCount(), 2u);
  EXPECT_TRUE(mesh.bounds().min().isApprox(Eigen::Vector3f(-1, 0, 0)));
  EXPECT_TRUE(mesh.bounds().max().isApprox(Eigen::Vector3f(1, 1, 5)));
  for (const MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      const auto at = [&](int k) { return part.vertices[part.indices[i + k]].position; };
      EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z(), 0) << "a triangle is inside out";
    }
    for (const Vertex& vertex : part.vertices) EXPECT_GT(vertex.normal.z(), 0.99f);
  }
}

TEST_F(TexturedMeshTest, LargeMeshesAreSimplifiedAndKeepTheirShape) {
  const std::string path = write("ball.obj", ballObj(120, 60));
  const TexturedMesh full = loadTexturedMesh(path, kUnscaled, kManyTriangles);
  ASSERT_GT(full.triangleCount(), 10000u);
  testing::internal::CaptureStderr();
  const TexturedMesh simple = loadTexturedMesh(path, kUnscaled, 1000);
  const std::string note = testing::internal::GetCapturedStderr();
  EXPECT_NE(note.find(path), std::string::npos) << note;
  EXPECT_LE(simple.triangleCount(), 1050u);
  EXPECT_GT(simple.triangleCount(), 700u);
  EXPECT_LT((simple.bounds().sizes() - full.bounds().sizes()).cwiseAbs().maxCoeff(), 0.003f);
  for (const Vertex& vertex : simple.parts.at(0).vertices) {
    EXPECT_NEAR((vertex.position - Eigen::Vector3f(0, 0, 0.05f)).norm(), 0.05f, 0.001f);
    EXPECT_GT(vertex.normal.dot((vertex.position - Eigen::Vector3f(0, 0, 0.05f)).normalized()), 0.9f);
  }
  for (const std::uint32_t index : simple.parts[0].indices) ASSERT_LT(index, simple.parts[0].vertices.size());
}

TEST_F(TexturedMeshTest, ErrorsNameThePathAndTheFault) {
  const std::string missing = folder_.path() + "/missing.obj";
  EXPECT_NE(errorOf(missing).find(missing + ": cannot be read as a mesh"), std::string::npos) << errorOf(missing);

  const std::string garbage = write("garbage.obj", "this is no mesh\n");
  EXPECT_NE(errorOf(garbage).find(garbage + ": has no triangles"), std::string::npos) << errorOf(garbage);

  const std::string points = write("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  EXPECT_NE(errorOf(points).find(points + ": has only points or lines"), std::string::npos) << errorOf(points);

  const std::string infinite = write("infinite.obj", "v 0 0 0\nv 1 0 0\nv 1 1e39 0\nf 1 2 3\n");
  EXPECT_NE(errorOf(infinite).find(infinite + ": vertex "), std::string::npos) << errorOf(infinite);
}

/// A pyramid of four triangles and one more face.
std::string pyramidPly(const std::string& face, const std::string& top = "0 0 1") {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 5\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n" +
         top + "\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n" + face + "\n";
}

TEST_F(TexturedMeshTest, RefusesDamagedFiles) {
  EXPECT_EQ(errorOf(write("good.ply", pyramidPly("3 0 2 1"))), "");
  const auto refusal = [&](const std::string& name, const std::string& text) { return errorOf(write(name, text)); };
  EXPECT_NE(refusal("header.ply", "ply\nformat ascii 1.0\n").find("its header has no end_header"), std::string::npos);
  const std::string in_a_word = replaced(pyramidPly("3 0 2 1"), "\nend_header", "_end_header");
  EXPECT_NE(refusal("word.ply", in_a_word).find("its header has no end_header"), std::string::npos);
  EXPECT_NE(refusal("index.ply", pyramidPly("3 0 1 900000")).find("out of range"), std::string::npos)
      << refusal("index.ply", pyramidPly("3 0 1 900000"));
  EXPECT_NE(refusal("nan.ply", pyramidPly("3 0 2 1", "nan nan nan")).find("vertex 3 of mesh '' is not finite"),
            std::string::npos);
  EXPECT_NE(refusal("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").find("have no area"), std::string::npos)
      << refusal("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_NE(refusal("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n").find("only points or lines"), std::string::npos)
      << refusal("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  EXPECT_NE(refusal("empty.obj", "").find("empty.obj: cannot be read as a mesh"), std::string::npos);
}

TEST_F(TexturedMeshTest, ReadsOnlyRegularFiles) {
  const std::string fifo = folder_.path() + "/fifo.obj";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(errorOf(fifo), fifo + ": cannot be read as a mesh: it is not a regular file");
  ASSERT_EQ(::mkfifo((folder_.path() + "/fifo.mtl").c_str(), 0600), 0);
  const std::string square = write("named.obj", replaced(kSquare, "square.mtl", "fifo.mtl"));
  EXPECT_EQ(errorOf(square), "");  // as with a missing material file
}

TEST_F(TexturedMeshTest, RefusesATextureThatClaimsTooManyPixels) {
  const std::string square = write("square.obj", kSquare);
  write("square.mtl", "newmtl cloth\nmap_Kd huge.png\n");
  // The second one overflows a signed number of 64 bits.
  const std::vector<std::pair<std::string, std::string>> edges = {{{0, 0, '\xea', 0x60}, "3600000000"},
                                                                  {"\xff\xff\xff\xff", "18446744065119617025"}};
  for (const auto& [edge, pixels] : edges) {
    write("huge.png",
          "\x89PNG\r\n\x1a\n" + std::string("\0\0\0\rIHDR", 8) + edge + edge + std::string("\x08\2\0\0\0", 5));
    EXPECT_NE(notesOf(square).find("huge.png claims to have " + pixels + " pixels"), std::string::npos)
        << notesOf(square);
  }
}

TEST_F(TexturedMeshTest, ATextureThatCannotBeReadIsNamedAndThePlainColourDrawn) {
  const std::string square = write("square.obj", kSquare);
  for (const std::string name : {"nowhere.png", "square.obj", "package://no_such_package/a.png", "http://a/b.png"}) {
    write("square.mtl", "newmtl cloth\nKd 0 1 0\nmap_Kd " + name + "\n");
    TexturedMesh mesh;
    const std::string notes = notesOf(square, &mesh);
    EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 1) << notes;
    EXPECT_NE(notes.find(square), std::string::npos) << notes;
    EXPECT_NE(notes.find(name), std::string::npos) << notes;
    EXPECT_EQ(mesh.parts.at(0).texture.texels.at(0), rgb(0, 255, 0));
    EXPECT_TRUE(mesh.adapted);
  }
}

TEST_F(TexturedMeshTest, AMissingMaterialFileIsNamed) {
  TexturedMesh mesh;
  const std::string notes = notesOf(write("square.obj", kSquare), &mesh);
  EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 1) << notes;
  EXPECT_NE(notes.find("square.mtl, which it names, cannot be read"), std::string::npos) << notes;
  EXPECT_EQ(mesh.triangleCount(), 2u);
}

TEST_F(TexturedMeshTest, TexturesAreFoundByUrlAndWithABlankAtTheirEnd) {
  write("package.xml", "<package/>");
  const std::string name = std::filesystem::path(folder_.path()).filename().string();
  const std::string parent = std::filesystem::path(folder_.path()).parent_path().string();
  ::setenv("GAZEBO_MODEL_PATH", ("/nowhere:" + parent).c_str(), 1);
  const char* const packages = std::getenv("ROS_PACKAGE_PATH");
  const std::string before = packages == nullptr ? "" : packages;
  ::setenv("ROS_PACKAGE_PATH", ("/nowhere:" + folder_.path()).c_str(), 1);
  writeImage("cloth.png", 8, 8);
  const std::string square = write("square.obj", kSquare);
  for (const std::string& url :
       {std::string("cloth.png  "), "file://" + folder_.path() + "/cloth.png", std::string("file://cloth.png"),
        "package://" + name + "/cloth.png", "package://" + name + "//cloth.png", "model://" + name + "/cloth.png",
        std::string(".\\cloth.png")}) {
    write("square.mtl", "newmtl cloth\nmap_Kd " + url + "\n");
    TexturedMesh mesh;
    EXPECT_EQ(notesOf(square, &mesh), "") << url;
    EXPECT_EQ(mesh.parts.at(0).texture.size, 8) << url;
  }
  ::setenv("ROS_PACKAGE_PATH", before.c_str(), 1);
  ::unsetenv("GAZEBO_MODEL_PATH");
}

TEST_F(TexturedMeshTest, ReadsTgaTextures) {
  // 2 x 2 pixels of 24 bits, the first row at the bottom, blue first.
  const std::string header("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\2\0\x18\0", 18);
  write("cloth.tga", header + std::string("\xff\0\0\xff\0\0", 6) + std::string("\0\0\xff\0\xff\0", 6));
  write("square.mtl", "newmtl cloth\nmap_Kd cloth.tga\n");
  TexturedMesh mesh;
  EXPECT_EQ(notesOf(write("square.obj", kSquare), &mesh), "");
  const Texture& texture = mesh.parts.at(0).texture;
  ASSERT_EQ(texture.size, 2);
  EXPECT_EQ(texture.texels,
            (std::vector<std::uint32_t>{rgb(255, 0, 0), rgb(0, 255, 0), rgb(0, 0, 255), rgb(0, 0, 255)}));
}

/// stb_image would take seconds to fill what is missing.
TEST_F(TexturedMeshTest, ATgaTextureWithFewerBytesThanItsPixelsNeedIsNone) {
  const std::string runs_of_8000_squared("\0\0\x0a\0\0\0\0\0\0\0\0\0\x40\x1f\x40\x1f\x18\0\xff\1\2\3", 22);
  const std::string cloth = write("cloth.tga", runs_of_8000_squared);
  write("square.mtl", "newmtl cloth\nmap_Kd cloth.tga\n");
  const std::string notes = notesOf(write("square.obj", kSquare));
  EXPECT_NE(notes.find(cloth + " is not an image that can be decoded"), std::string::npos) << notes;
}

/// A box of 0.1 m with a vertex for each corner. @param inwards which way its faces point.
std::string boxPly(bool inwards, bool colours) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
  if (colours) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  text += "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 8; ++i) {
    text += std::to_string(0.1 * (i & 1)) + " " + std::to_string(0.1 * (i >> 1 & 1)) + " " +
            std::to_string(0.1 * (i >> 2 & 1)) + (colours ? i >= 4 ? " 255 0 0" : " 0 0 255" : "") + "\n";
  }
  for (const auto& face :
       {std::array<int, 4>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    text += "4";
    for (int k = 0; k < 4; ++k) text += " " + std::to_string(face[inwards ? 3 - k : k]);
    text += "\n";
  }
  return text;
}

std::uint32_t colorAt(const MeshPart& part, const Vertex& vertex) {
  const auto texel = [&](float coordinate) {
    return static_cast<int>(coordinate * static_cast<float>(part.texture.size));
  };
  return part.texture.texels.at(static_cast<std::size_t>(texel(vertex.uv.y())) * part.texture.size +
                                texel(vertex.uv.x()));
}

TEST_F(TexturedMeshTest, VertexColoursBecomeATexture) {
  TexturedMesh mesh;
  EXPECT_EQ(notesOf(write("box.ply", boxPly(false, true)), &mesh), "");
  EXPECT_TRUE(mesh.adapted);
  ASSERT_EQ(mesh.parts.size(), 1u);
  const MeshPart& part = mesh.parts[0];
  EXPECT_EQ(mesh.triangleCount(), 12u);
  for (const std::uint32_t texel : part.texture.texels) {
    EXPECT_EQ(texel >> 24, 255u) << "an unused texel, which reduced copies mix in, is not black";
  }
  for (const Vertex& vertex : part.vertices) {
    EXPECT_EQ(colorAt(part, vertex), vertex.position.z() > 0.05f ? rgb(255, 0, 0) : rgb(0, 0, 255));
  }
  // In the middle of a side's triangle the colour is the mean of its corners' colours.
  int mixed = 0;
  for (std::size_t i = 0; i < part.indices.size(); i += 3) {
    Vertex middle = part.vertices[part.indices[i]];
    for (int k = 1; k < 3; ++k) {
      middle.uv += part.vertices[part.indices[i + k]].uv;
      middle.position += part.vertices[part.indices[i + k]].position;
    }
    middle.uv /= 3;
    const float height = middle.position.z() / 3;
    const std::uint32_t color = colorAt(part, middle);
    EXPECT_NEAR(static_cast<float>(color & 255u), 255 * height / 0.1f, 20);
    EXPECT_NEAR(static_cast<float>(color >> 16 & 255u), 255 * (1 - height / 0.1f), 20);
    mixed += height > 0.01f && height < 0.09f;
  }
  EXPECT_EQ(mixed, 8);
}

TEST_F(TexturedMeshTest, VertexColoursSurviveSimplification) {
  std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1681\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 3200\n"
      "property list uchar int vertex_indices\nend_header\n";
  std::ostringstream text;
  text << header;
  for (int y = 0; y <= 40; ++y) {
    for (int x = 0; x <= 40; ++x) text << x * 0.01 << ' ' << y * 0.01 << " 0 " << 6 * x << " 0 " << 6 * y << "\n";
  }
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const int i = 41 * y + x;
      text << "3 " << i << ' ' << i + 1 << ' ' << i + 42 << "\n3 " << i << ' ' << i + 42 << ' ' << i + 41 << "\n";
    }
  }
  TexturedMesh mesh;
  EXPECT_NE(notesOf(write("sheet.ply", text.str()), &mesh, 400).find("6400 triangles simplified to"),
            std::string::npos);
  EXPECT_LE(mesh.triangleCount(), 420u) << "both sides";
  for (const Vertex& vertex : mesh.parts.at(0).vertices) {
    const std::uint32_t color = colorAt(mesh.parts[0], vertex);
    EXPECT_NEAR(static_cast<float>(color & 255u), vertex.position.x() * 600, 2);
    EXPECT_NEAR(static_cast<float>(color >> 16 & 255u), vertex.position.y() * 600, 2);
  }
}

TEST_F(TexturedMeshTest, SharedVerticesKeepSharpEdges) {
  TexturedMesh mesh;
  EXPECT_EQ(notesOf(write("box.ply", boxPly(false, false)), &mesh), "");
  for (const Vertex& vertex : mesh.parts.at(0).vertices) {
    EXPECT_NEAR(vertex.normal.cwiseAbs().maxCoeff(), 1, 1e-6) << "a box has flat sides";
  }
  EXPECT_EQ(mesh.parts[0].vertices.size(), 24u);
}

TEST_F(TexturedMeshTest, ADegenerateTriangleDoesNotOpenAMesh) {
  const std::string one_more = replaced(boxPly(false, false), "element face 6", "element face 7") + "3 0 0 1\n";
  TexturedMesh mesh;
  EXPECT_EQ(notesOf(write("box.ply", one_more), &mesh), "");
  EXPECT_LE(mesh.triangleCount(), 13u) << "PLY files are two-sided where they are open";
}

TEST_F(TexturedMeshTest, WallsThatAreSeenFromInsideAreNotTurned) {
  testing::internal::CaptureStderr();
  loadTexturedMesh(write("room.ply", boxPly(true, false)), kUnscaled, kManyTriangles, MeshPurpose::kSurroundings);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(TexturedMeshTest, OneMaterialMayHaveMeshesWithAndWithoutVertexColours) {
  write("square.mtl", "newmtl cloth\nKd 0 1 0\n");
  TexturedMesh mesh;
  notesOf(
      write("two.obj", std::string("mtllib square.mtl\no a\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 0 1 1 0 0\nusemtl cloth\n"
                                   "f 1 2 3\no b\nv 0 2 0\nv 1 2 0\nv 0 2 1\nf 4 5 6\n")),
      &mesh);
  for (const MeshPart& part : mesh.parts) {
    for (const Vertex& vertex : part.vertices) {
      EXPECT_NE(colorAt(part, vertex), rgb(255, 255, 255)) << "neither the file's colours nor its material's";
    }
  }
}

TEST_F(TexturedMeshTest, AClosedMeshWhoseFacesPointInwardsIsTurned) {
  for (const bool inwards : {false, true}) {
    TexturedMesh mesh;
    const std::string notes = notesOf(write("box.ply", boxPly(inwards, false)), &mesh);
    EXPECT_EQ(notes.find("its faces point inwards") != std::string::npos, inwards) << notes;
    EXPECT_EQ(mesh.adapted, inwards);
    const MeshPart& part = mesh.parts.at(0);
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      const Vertex &a = part.vertices[part.indices[i]], &b = part.vertices[part.indices[i + 1]],
                   &c = part.vertices[part.indices[i + 2]];
      const Eigen::Vector3f outwards = a.position - Eigen::Vector3f::Constant(0.05f);
      EXPECT_GT((b.position - a.position).cross(c.position - a.position).dot(outwards), 0);
      EXPECT_GT(a.normal.dot(outwards), 0);
    }
  }
}

/// A glTF file of one triangle, from (0, 0, 0) to 0.2 along x and 0.3 along y.
std::string triangleGltf(const std::string& material) {
  const float numbers[9] = {0, 0, 0, 0.2f, 0, 0, 0, 0.3f, 0};
  const std::string bytes(reinterpret_cast<const char*>(numbers), sizeof(numbers));
  const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned three = 0;
    for (int k = 0; k < 3; ++k) three = three << 8 | static_cast<unsigned char>(bytes[i + k]);
    for (int shift = 18; shift >= 0; shift -= 6) base64 += digits[three >> shift & 63];
  }
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
{"attributes":{"POSITION":0},"material":0}]}],"materials":[)" +
         material + R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":3,
"type":"VEC3","min":[0,0,0],"max":[0.2,0.3,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
"uri":"data:application/octet-stream;base64,)" +
         base64 + "\"}]}";
}

TEST_F(TexturedMeshTest, GltfStandsUprightInItsPlainColour) {
  TexturedMesh mesh;
  const std::string orange = R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]}})";
  EXPECT_EQ(notesOf(write("triangle.gltf", triangleGltf(orange)), &mesh), "");
  EXPECT_LT((mesh.bounds().sizes() - Eigen::Vector3f(0.2f, 0, 0.3f)).norm(), 1e-6f);
  EXPECT_EQ(mesh.triangleCount(), 1u);
  EXPECT_EQ(mesh.parts.at(0).texture.texels.at(0), rgb(255, 188, 0)) << "0.5 of the light is 188 in sRGB";
  EXPECT_LT((mesh.parts[0].vertices[0].normal + Eigen::Vector3f::UnitY()).norm(), 1e-6f) << "glTF's front is -y here";
}

/// A triangle from the origin to x = 1 and to (0, 2, 3). @param asset what it says about axes and units.
std::string triangleCollada(const std::string& asset) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset + R"(</asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="pa" count="9">0 0 0 1 0 0 0 2 3</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(TexturedMeshTest, ColladaFilesKeepTheirAxesAndHaveTheirUnitAsInRviz) {
  // rviz leaves out the turn that assimp makes of up_axis.
  for (const char* asset : {"", "<up_axis>X_UP</up_axis>", "<up_axis>Y_UP</up_axis>", "<up_axis>Z_UP</up_axis>"}) {
    const TexturedMesh mesh = loadTexturedMesh(write("axes.dae", triangleCollada(asset)), kUnscaled, kManyTriangles);
    EXPECT_TRUE(mesh.bounds().min().isApprox(Eigen::Vector3f(0, 0, 0))) << asset;
    EXPECT_TRUE(mesh.bounds().max().isApprox(Eigen::Vector3f(1, 2, 3))) << asset;
  }
  const std::string inches = R"(<unit meter="0.0254" name="inch"/><up_axis>Y_UP</up_axis>)";
  const TexturedMesh mesh = loadTexturedMesh(write("inches.dae", triangleCollada(inches)), kUnscaled, kManyTriangles);
  EXPECT_TRUE(mesh.bounds().max().isApprox(0.0254f * Eigen::Vector3f(1, 2, 3)));
}

TEST_F(TexturedMeshTest, TwoSidedMaterialsHaveABack) {
  TexturedMesh mesh;
  EXPECT_EQ(notesOf(write("triangle.gltf", triangleGltf(R"({"doubleSided":true})")), &mesh), "");
  ASSERT_EQ(mesh.triangleCount(), 2u);
  Eigen::Vector3f areas = Eigen::Vector3f::Zero();
  const MeshPart& part = mesh.parts.at(0);
  for (std::size_t i = 0; i < 6; i += 3) {
    const Eigen::Vector3f a = part.vertices[part.indices[i]].position, b = part.vertices[part.indices[i + 1]].position,
                          c = part.vertices[part.indices[i + 2]].position;
    areas += (b - a).cross(c - a);
    EXPECT_GT((b - a).cross(c - a).dot(part.vertices[part.indices[i]].normal), 0);
  }
  EXPECT_LT(areas.norm(), 1e-7f);
}

TEST_F(TexturedMeshTest, ATextureIsNotTornBySimplification) {
  // Every triangle has texture coordinates of its own: nothing can be collapsed without tearing.
  MeshPart ball;
  appendBall(ball, 0.05f, 0.1f, 40, 20);
  std::ostringstream text;
  text << "mtllib cloth.mtl\nusemtl cloth\n";
  for (const Vertex& v : ball.vertices) {
    text << "v " << v.position.x() << ' ' << v.position.y() << ' ' << v.position.z() << '\n';
  }
  for (std::size_t i = 0; i < ball.indices.size(); i += 3) {
    for (int k = 0; k < 3; ++k) text << "vt " << (static_cast<double>(i) + k) / 10000 << ' ' << k * 0.3 << '\n';
    text << 'f';
    for (int k = 0; k < 3; ++k) text << ' ' << ball.indices[i + k] + 1 << '/' << i + k + 1;
    text << '\n';
  }
  const std::string path = write("islands.obj", text.str());
  writeImage("cloth.png", 64, 64);
  write("cloth.mtl", "newmtl cloth\nmap_Kd cloth.png\n");
  TexturedMesh mesh;
  const std::string notes = notesOf(path, &mesh, 300);
  EXPECT_NE(notes.find("not to 300, because fewer would tear the texture"), std::string::npos) << notes;
  for (const MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      const float u = part.vertices[part.indices[i]].uv.x();
      EXPECT_NEAR(part.vertices[part.indices[i + 1]].uv.x(), u, 0.0005f) << "corners of different islands";
    }
  }
  write("cloth.mtl", "newmtl cloth\nKd 1 0 0\n");  // one colour: nothing to tear
  EXPECT_EQ(notesOf(path, &mesh, 300).find("because"), std::string::npos);
  EXPECT_LE(mesh.triangleCount(), 315u);
}

TEST_F(TexturedMeshTest, DamagedFilesOfEveryFormatCostAnErrorAtMost) {
  const std::string collada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse><color>1 0 0 1</color></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION"
source="#p"/></vertices><triangles material="s" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="vs"><node><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#vs"/></scene></COLLADA>
)";
  core::Random random(1);
  for (const auto& [name, good] :
       {std::pair<std::string, std::string>("m.ply", pyramidPly("3 0 2 1")), {"m.obj", kSquare}, {"m.dae", collada}}) {
    EXPECT_EQ(errorOf(write(name, good)).find("crashes"), std::string::npos);
    int refused = 0;
    for (int i = 0; i < 30; ++i) {
      std::string text = good;
      const int size = static_cast<int>(text.size());
      if (i % 3 == 0) text.resize(random.below(size));
      if (i % 3 == 1) text.erase(random.below(size), 1 + random.below(60));
      if (i % 3 == 2) text[random.below(size)] = static_cast<char>(random.below(256));
      refused += !errorOf(write(name, text)).empty();
    }
    EXPECT_GT(refused, 0) << name;
  }
}

TEST_F(TexturedMeshTest, RealScansLoad) {
  const auto folder = ycbFolder();
  if (!folder) GTEST_SKIP() << kNoYcbScans;
  const std::vector<std::string> scans = ycbMeshes(*folder);
  EXPECT_FALSE(scans.empty()) << "no textured.obj in " << *folder;
  for (const std::string& path : scans) {
    SCOPED_TRACE(path);
    const TexturedMesh mesh = loadTexturedMesh(path, kUnscaled, 2000);
    EXPECT_GT(mesh.triangleCount(), 500u);
    EXPECT_LE(mesh.triangleCount(), 2000u);
    const Eigen::Vector3f size = mesh.bounds().sizes();
    EXPECT_GT(size.maxCoeff(), 0.03f);  // [m]: a strawberry
    EXPECT_LT(size.maxCoeff(), 0.35f);  // a plate
    for (const MeshPart& part : mesh.parts) {
      EXPECT_EQ(part.texture.size, 256);
      for (const Vertex& vertex : part.vertices) ASSERT_NEAR(vertex.normal.norm(), 1, 1e-4);
    }
  }
}

}  // namespace
}  // namespace early_fusion::world
