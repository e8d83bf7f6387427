/* The door to OpenMesh's writers (src/mesh_file_io.h): exceptions end here, and its chatter is not heard. */
#include "src/mesh_file_io.h"

extern "C" {
#include "src/file_io.h"
}

// OpenMesh's points start out without a value; gcc 12 sees that through its vectors and warns about their growth.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cctype>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

constexpr int float_digits = 9; // enough to read back the same float

/* OpenMesh tells standard output and standard error what it does; not while one of these lives. */
class Silence {
  public:
    Silence() {
        omlog().disable();
        omout().disable();
        omerr().disable();
    }
    ~Silence() {
        omerr().enable();
        omout().enable();
    }
};

/* "ply" for "a/b.PLY"; "" for a name without an ending. */
std::string ending_of(const std::string &path) {
    const auto slash = path.rfind('/'), dot = path.rfind('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "";
    std::string ending = path.substr(dot + 1);
    for (char &c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

bool is_known(const std::string &ending) {
    return ending == "ply" || ending == "obj" || ending == "stl" || ending == "off";
}

/* Half-edges hold no third triangle at an edge: such a triangle gets vertices of its own. */
void build(Mesh &mesh, const double *xyz, uint32_t vertex_count, const uint32_t *corners, uint32_t triangle_count) {
    std::vector<Mesh::VertexHandle> vertices;
    vertices.reserve(vertex_count);
    mesh.reserve(vertex_count, static_cast<size_t>(vertex_count) + triangle_count, triangle_count);
    for (size_t i = 0; i < vertex_count; i++)
        vertices.push_back(mesh.add_vertex(Mesh::Point(
            static_cast<float>(xyz[3 * i]), static_cast<float>(xyz[3 * i + 1]), static_cast<float>(xyz[3 * i + 2]))));
    for (size_t t = 0; t < triangle_count; t++) {
        Mesh::VertexHandle corner[3];
        for (size_t k = 0; k < 3; k++) corner[k] = vertices[corners[3 * t + k]];
        if (mesh.add_face(corner[0], corner[1], corner[2]).is_valid()) continue;
        for (auto &vertex : corner) vertex = mesh.add_vertex(Mesh::Point(mesh.point(vertex)));
        mesh.add_face(corner[0], corner[1], corner[2]);
    }
}

enum scree_status write(const char *path, const double *xyz, uint32_t vertex_count, const uint32_t *corners,
                        uint32_t triangle_count, struct scree_error *error) {
    const std::string ending = ending_of(path);
    if (!is_known(ending))
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: meshes are written as .ply, .obj, .stl or .off", path);
    Mesh mesh;
    std::ostringstream text(std::ios::binary);
    const bool as_binary = ending == "ply" || ending == "stl";
    const OpenMesh::IO::Options options(as_binary ? OpenMesh::IO::Options::Binary : OpenMesh::IO::Options::Default);
    const Silence silence;
    build(mesh, xyz, vertex_count, corners, triangle_count);
    if (!OpenMesh::IO::write_mesh(mesh, text, "." + ending, options, float_digits) || !text)
        return scree_fail(error, SCREE_E_IO, "%s: OpenMesh could not write the mesh", path);
    const std::string bytes = text.str();
    return file_replace(path, bytes.data(), bytes.size(), error);
}

} // namespace

extern "C" bool mesh_file_is_known(const char *path) {
    try {
        return is_known(ending_of(path));
    } catch (...) {
        return false;
    }
}

extern "C" enum scree_status mesh_file_write(const char *path, const double *xyz, uint32_t vertex_count,
                                             const uint32_t *corners, uint32_t triangle_count,
                                             struct scree_error *error) {
    try {
        return write(path, xyz, vertex_count, corners, triangle_count, error);
    } catch (const std::bad_alloc &) {
        return scree_fail(error, SCREE_E_MEMORY, "%s: no memory for the mesh", path);
    } catch (const std::exception &problem) {
        return scree_fail(error, SCREE_E_IO, "%s: %s", path, problem.what());
    } catch (...) {
        return scree_fail(error, SCREE_E_IO, "%s: OpenMesh could not write the mesh", path);
    }
}
