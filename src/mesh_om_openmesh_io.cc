/* OM files by OpenMesh, whose reader believes what files say and ends the program where it must not be so. It gets a
 * copy that holds positions and faces only, with all counts and sizes checked; exceptions end here. */
#include "src/mesh_parts.h"

extern "C" {
#include "stream/cursor.h"
}

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/OMFormat.hh>
#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace Format = OpenMesh::IO::OMFormat;
using Format::Chunk;

constexpr unsigned newest_version = 2 << 5 | 2;     // 2.2: what OpenMesh 9.0 writes
constexpr unsigned first_half_edges = 2 << 5;       // 2.0: faces are rings of half-edges, corners before
constexpr unsigned first_custom_types = 2 << 5 | 2; // custom properties tell their types
constexpr size_t longest_ring = 1000;

/* Takes what the reader finds, and no more than the counts that were checked. */
class Importer : public OpenMesh::IO::BaseImporter {
  public:
    std::vector<OpenMesh::Vec3d> points;
    std::vector<int> corners;  // of faces with all their corners, each led by their number
    std::vector<int> to, next; // of half-edges
    std::vector<int> faces;    // a half-edge each

    OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f &point) override {
        return add_vertex(OpenMesh::Vec3d(point[0], point[1], point[2]));
    }
    OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3d &point) override {
        points.push_back(point);
        return OpenMesh::VertexHandle(static_cast<int>(points.size()) - 1);
    }
    OpenMesh::VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3d(0, 0, 0)); }
    OpenMesh::HalfedgeHandle add_edge(OpenMesh::VertexHandle from, OpenMesh::VertexHandle end) override {
        to.push_back(end.idx());
        to.push_back(from.idx());
        next.resize(to.size(), -1);
        return OpenMesh::HalfedgeHandle(static_cast<int>(to.size()) - 2);
    }
    OpenMesh::FaceHandle add_face(const VHandles &face) override {
        corners.push_back(static_cast<int>(face.size()));
        for (const auto corner : face) corners.push_back(corner.idx());
        return OpenMesh::FaceHandle(0);
    }
    OpenMesh::FaceHandle add_face(OpenMesh::HalfedgeHandle half_edge) override {
        faces.push_back(half_edge.idx());
        return OpenMesh::FaceHandle(static_cast<int>(faces.size()) - 1);
    }
    void set_next(OpenMesh::HalfedgeHandle half_edge, OpenMesh::HalfedgeHandle after) override {
        if (static_cast<size_t>(half_edge.idx()) < next.size()) next[half_edge.idx()] = after.idx();
    }
    size_t n_vertices() const override { return points.size(); }
    size_t n_faces() const override { return faces.size(); }
    size_t n_edges() const override { return to.size() / 2; }
    OpenMesh::BaseKernel *kernel() override { return &kernel_; }

    // What does not matter here.
    void set_point(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_halfedge(OpenMesh::VertexHandle, OpenMesh::HalfedgeHandle) override {}
    void set_face(OpenMesh::HalfedgeHandle, OpenMesh::FaceHandle) override {}
    void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3d &) override {}
    void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3f &) override {}
    void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3d &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3uc &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4uc &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_color(OpenMesh::VertexHandle, const OpenMesh::Vec4f &) override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3uc &) override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4uc &) override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3f &) override {}
    void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4f &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3uc &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4uc &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3f &) override {}
    void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4f &) override {}
    void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec2f &) override {}
    void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec3f &) override {}
    void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec2f &) override {}
    void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec3f &) override {}
    void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                            const std::vector<OpenMesh::Vec2f> &) override {}
    void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                            const std::vector<OpenMesh::Vec3f> &) override {}
    void set_face_texindex(OpenMesh::FaceHandle, int) override {}
    void request_face_texcoords2D() override {}
    void set_status(OpenMesh::VertexHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void set_status(OpenMesh::HalfedgeHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void set_status(OpenMesh::EdgeHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void set_status(OpenMesh::FaceHandle, const OpenMesh::Attributes::StatusInfo &) override {}
    void add_texture_information(int, std::string) override {}

  private:
    OpenMesh::BaseKernel kernel_;
};

/* ---- the checked copy ---- */

struct Header {
    unsigned char mesh, version; // 'T', 'Q' or 'P' for triangles, quads, polygons
    uint64_t vertices, faces, edges;
};

struct Part {
    unsigned entity, type, bits;
    bool is_named, is_float;
    unsigned dimensions;
};

Part part_of(uint16_t head) {
    const auto field = [head](int from, int size) { return (head >> from) & ((1u << size) - 1); };
    return {field(Chunk::OFF_ENTITY, Chunk::SIZE_ENTITY),    field(Chunk::OFF_TYPE, Chunk::SIZE_TYPE),
            field(Chunk::OFF_BITS, Chunk::SIZE_BITS),        field(Chunk::OFF_NAME, Chunk::SIZE_NAME) != 0,
            field(Chunk::OFF_FLOAT, Chunk::SIZE_FLOAT) != 0, field(Chunk::OFF_DIM, Chunk::SIZE_DIM) + 1};
}

bool is_wanted(const Part &part) {
    return (part.entity == Chunk::Entity_Vertex && part.type == Chunk::Type_Pos) ||
           (part.type == Chunk::Type_Topology &&
            (part.entity == Chunk::Entity_Halfedge || part.entity == Chunk::Entity_Face));
}

/* Polygons of before 2.0: each with its number of corners in front. */
bool step_over_polygons(struct scree_reader &reader, uint64_t count, size_t index_bytes) {
    for (uint64_t i = 0; i < count && !reader.ran_out; i++) {
        const uint16_t corner_count = scree_read_u16(&reader);
        scree_read_bytes(&reader, corner_count * index_bytes);
    }
    return !reader.ran_out;
}

/* To the end of a part's data. False: it is not all there, or of a kind that nobody knows. */
bool step_over(struct scree_reader &reader, const Header &header, const Part &part) {
    uint64_t count = part.entity == Chunk::Entity_Vertex     ? header.vertices
                     : part.entity == Chunk::Entity_Face     ? header.faces
                     : part.entity == Chunk::Entity_Edge     ? header.edges
                     : part.entity == Chunk::Entity_Halfedge ? 2 * header.edges
                                                             : 1;
    const size_t index_bytes = size_t{1} << part.bits;
    size_t size = 0;
    switch (part.type) {
    case Chunk::Type_Pos:
    case Chunk::Type_Normal:
        if (!part.is_float || part.dimensions != 3 || part.bits > Chunk::Float_64) return false;
        size = 3 * sizeof(float) << part.bits;
        break;
    case Chunk::Type_Texcoord: size = 2 * sizeof(float); break;
    case Chunk::Type_Color: size = 3; break;
    case Chunk::Type_Status: size = 4; break;
    case Chunk::Type_Custom:
        if (header.version >= first_custom_types) scree_read_bytes(&reader, scree_read_u8(&reader));
        return scree_read_bytes(&reader, scree_read_u32(&reader)) != nullptr;
    case Chunk::Type_Topology:
        if (part.bits == Chunk::Integer_64) return false;
        size = index_bytes;
        if (part.entity == Chunk::Entity_Halfedge) size *= 3; // next one, point at its end, face
        if (part.entity != Chunk::Entity_Face || header.version >= first_half_edges) break;
        if (header.mesh == 'P') return step_over_polygons(reader, count, index_bytes);
        size *= header.mesh == 'Q' ? 4 : 3;
        break;
    default: return false;
    }
    if (!scree_reader_holds(&reader, count, size)) return false;
    scree_read_bytes(&reader, static_cast<size_t>(count) * size);
    return true;
}

enum scree_status cut_off(const struct mesh_source *source, struct scree_error *error) {
    return scree_fail(error, SCREE_E_CORRUPT, "%s: is cut off, or has a part that is not known; save it as PLY",
                      source->name);
}

/* Positions, half-edges and faces, each of them once at most. */
enum scree_status copy_wanted(const struct mesh_source *source, Header &header, std::string &copy,
                              struct scree_error *error) {
    struct scree_reader reader = scree_reader(source->bytes, source->size_bytes);
    const unsigned char *magic = scree_read_bytes(&reader, 4);
    bool has_entity[8] = {};
    if (magic == nullptr || magic[0] != 'O' || magic[1] != 'M' ||
        (magic[2] != 'T' && magic[2] != 'Q' && magic[2] != 'P'))
        return scree_fail(error, SCREE_E_CORRUPT, "%s: does not begin as OM does", source->name);
    header.mesh = magic[2];
    header.version = magic[3];
    header.vertices = scree_read_u32(&reader);
    header.faces = scree_read_u32(&reader);
    header.edges = scree_read_u32(&reader);
    if (header.version > newest_version)
        return scree_fail(error, SCREE_E_UNSUPPORTED, "%s: is of a later version of OM than 2.2; save it as PLY",
                          source->name);
    if (reader.ran_out || header.vertices >= INT32_MAX || header.faces >= INT32_MAX || header.edges >= INT32_MAX / 2)
        return cut_off(source, error);
    copy.assign(reinterpret_cast<const char *>(source->bytes), reader.at_bytes);
    while (scree_reader_left(&reader) > 0) {
        const size_t start = reader.at_bytes;
        const Part part = part_of(scree_read_u16(&reader));
        if (part.entity == Chunk::Entity_Sentinel) break;
        if (part.is_named) scree_read_bytes(&reader, scree_read_u8(&reader));
        const bool wanted = is_wanted(part);
        if (reader.ran_out || (wanted && (part.is_named || has_entity[part.entity])) ||
            !step_over(reader, header, part) || reader.ran_out)
            return cut_off(source, error);
        if (!wanted) continue;
        has_entity[part.entity] = true;
        copy.append(reinterpret_cast<const char *>(source->bytes) + start, reader.at_bytes - start);
    }
    return SCREE_OK;
}

/* ---- the TIN ---- */

/* Half-edges around a face, which have to come back to the first one. */
enum scree_status take_ring(struct mesh_source *source, const Importer &found, int first, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    int half_edge = first;
    size_t length = 0;
    mesh_begin_face(source);
    do {
        if (half_edge < 0 || static_cast<size_t>(half_edge) >= found.to.size() || ++length > longest_ring)
            return scree_fail(error, SCREE_E_CORRUPT, "%s: has a face without a closed ring of edges", source->name);
        status = mesh_add_corner(source, found.to[static_cast<size_t>(half_edge)], error);
        half_edge = found.next[static_cast<size_t>(half_edge)];
    } while (status == SCREE_OK && half_edge != first);
    return status;
}

enum scree_status take(struct mesh_source *source, const Importer &found, struct scree_error *error) {
    enum scree_status status = mesh_reserve(source, found.points.size(), found.faces.size(), error);
    for (size_t i = 0; i < found.points.size() && status == SCREE_OK; i++)
        status = mesh_add_point(source, found.points[i].data(), error);
    for (size_t i = 0; i < found.faces.size() && status == SCREE_OK; i++)
        status = take_ring(source, found, found.faces[i], error);
    for (size_t i = 0; i < found.corners.size() && status == SCREE_OK;) {
        int left = found.corners[i++];
        mesh_begin_face(source);
        for (; left > 0 && status == SCREE_OK; left--) status = mesh_add_corner(source, found.corners[i++], error);
    }
    return status;
}

enum scree_status read(struct mesh_source *source, struct scree_error *error) {
    Header header;
    std::string copy;
    enum scree_status status = copy_wanted(source, header, copy, error);
    if (status != SCREE_OK) return status;
    Importer found;
    OpenMesh::IO::Options options(OpenMesh::IO::Options::Binary);
    std::istringstream stream(copy, std::ios::binary);
    copy = std::string();
    stream.unsetf(std::ios::skipws); // as OpenMesh does with files
    omerr().disable();
    const bool is_read = OpenMesh::IO::IOManager().read(stream, ".om", found, options);
    omerr().enable();
    return is_read ? take(source, found, error)
                   : scree_fail(error, SCREE_E_CORRUPT, "%s: OpenMesh cannot read it", source->name);
}

} // namespace

extern "C" enum scree_status mesh_read_om(struct mesh_source *source, struct scree_error *error) {
    try {
        return read(source, error);
    } catch (const std::bad_alloc &) {
        return scree_fail(error, SCREE_E_MEMORY, "%s: no memory for the mesh", source->name);
    } catch (const std::exception &problem) {
        return scree_fail(error, SCREE_E_CORRUPT, "%s: %s", source->name, problem.what());
    } catch (...) {
        return scree_fail(error, SCREE_E_CORRUPT, "%s: OpenMesh cannot read it", source->name);
    }
}
