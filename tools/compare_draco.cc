/* SPDX-License-Identifier: MIT */
/** @file compare_draco.cc  The Draco mesh codec behind C functions: the only C++ of the project. */
#include "compare_draco.h"
#include "compare_clock.h"

#include <array>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <vector>

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

extern "C" {
#include "base/result.h"
}

namespace {

constexpr int kSlowest = 0; // draco_encoder's compression level 10

/* Runs `work` and turns whatever it throws into a result: an exception must not reach C. */
template <typename Work> gvc_result without_exceptions(gvc_error *error, Work work) {
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return gvc_fail_memory(error);
    } catch (const std::exception &thrown) {
        return gvc_fail(error, GVC_ERROR_INTERNAL, "Draco threw: %s", thrown.what());
    } catch (...) {
        return gvc_fail(error, GVC_ERROR_INTERNAL, "Draco threw something unknown");
    }
}

void set_positions(const gvc_mesh *from, draco::Mesh *to) {
    const auto count = static_cast<uint32_t>(gvc_mesh_vertex_count(from));
    const double *positions = gvc_mesh_positions(from);
    to->set_num_points(count);
    draco::GeometryAttribute layout;
    layout.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false,
                3 * sizeof(float), 0);
    const int id = to->AddAttribute(layout, true, count);
    draco::PointAttribute *attribute = to->attribute(id);
    for (uint32_t v = 0; v < count; v++) {
        const std::array<float, 3> value = {static_cast<float>(positions[3 * size_t{v}]),
                                            static_cast<float>(positions[3 * size_t{v} + 1]),
                                            static_cast<float>(positions[3 * size_t{v} + 2])};
        attribute->SetAttributeValue(draco::AttributeValueIndex(v), value.data());
    }
}

void set_faces(const gvc_mesh *from, draco::Mesh *to) {
    const auto count = static_cast<uint32_t>(gvc_mesh_face_count(from));
    const uint32_t *faces = gvc_mesh_faces(from);
    to->SetNumFaces(count);
    for (uint32_t f = 0; f < count; f++) {
        draco::Mesh::Face face;
        for (int c = 0; c < 3; c++) {
            face[c] = draco::PointIndex(faces[3 * size_t{f} + static_cast<size_t>(c)]);
        }
        to->SetFace(draco::FaceIndex(f), face);
    }
}

gvc_result encode(const gvc_mesh *mesh, int bits, unsigned char **data, size_t *size,
                  double *seconds, gvc_error *error) {
    if (gvc_mesh_vertex_count(mesh) > INT32_MAX || gvc_mesh_face_count(mesh) > INT32_MAX) {
        return gvc_fail(error, GVC_ERROR_LIMIT, "too many vertices or faces for Draco");
    }
    for (size_t i = 0; i < 3 * gvc_mesh_vertex_count(mesh); i++) {
        if (std::fabs(gvc_mesh_positions(mesh)[i]) > FLT_MAX) {
            return gvc_fail(error, GVC_ERROR_MESH, "vertex %zu is too far out for float32", i / 3);
        }
    }
    draco::Mesh made;
    set_positions(mesh, &made);
    set_faces(mesh, &made);

    const double begin = compare_thread_seconds();
    made.DeduplicateAttributeValues();
    made.DeduplicatePointIds();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetSpeedOptions(kSlowest, kSlowest);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(made, &buffer);
    *seconds = compare_thread_seconds() - begin;
    if (!status.ok()) {
        return gvc_fail(error, GVC_ERROR_MESH, "Draco cannot encode the mesh: %s",
                        status.error_msg());
    }

    auto *copy = static_cast<unsigned char *>(std::malloc(buffer.size() ? buffer.size() : 1));
    if (!copy) return gvc_fail_memory(error);
    std::memcpy(copy, buffer.data(), buffer.size());
    *data = copy;
    *size = buffer.size();
    return GVC_OK;
}

gvc_result to_gvc(const draco::Mesh &from, gvc_mesh **mesh, gvc_error *error) {
    const draco::PointAttribute *attribute =
        from.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (!attribute || attribute->num_components() != 3) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "Draco decoded a mesh without positions");
    }
    std::vector<double> positions(3 * size_t{from.num_points()});
    for (uint32_t v = 0; v < from.num_points(); v++) {
        std::array<float, 3> value;
        if (!attribute->ConvertValue(attribute->mapped_index(draco::PointIndex(v)), 3,
                                     value.data())) {
            return gvc_fail(error, GVC_ERROR_CORRUPT, "Draco decoded an unreadable position");
        }
        for (size_t k = 0; k < 3; k++) positions[3 * size_t{v} + k] = static_cast<double>(value[k]);
    }
    std::vector<uint32_t> faces(3 * size_t{from.num_faces()});
    for (uint32_t f = 0; f < from.num_faces(); f++) {
        for (int c = 0; c < 3; c++) {
            faces[3 * size_t{f} + static_cast<size_t>(c)] =
                from.face(draco::FaceIndex(f))[c].value();
        }
    }
    return gvc_mesh_create(positions.data(), from.num_points(), faces.data(), from.num_faces(),
                           mesh, error);
}

gvc_result decode(const unsigned char *data, size_t size, gvc_mesh **mesh, double *seconds,
                  gvc_error *error) {
    const double begin = compare_thread_seconds();
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(data), size);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    *seconds = compare_thread_seconds() - begin;
    if (!decoded.ok()) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "Draco cannot decode: %s",
                        decoded.status().error_msg());
    }
    return to_gvc(*decoded.value(), mesh, error);
}

} // namespace

gvc_result compare_draco_encode(const gvc_mesh *mesh, int bits, unsigned char **data, size_t *size,
                                double *seconds, gvc_error *error) {
    *data = nullptr;
    *size = 0;
    *seconds = 0;
    if (bits < 1 || bits > 30) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "Draco has 1 to 30 bits per coordinate, not %d",
                        bits);
    }
    return without_exceptions(error,
                              [=] { return encode(mesh, bits, data, size, seconds, error); });
}

gvc_result compare_draco_decode(const unsigned char *data, size_t size, gvc_mesh **mesh,
                                double *seconds, gvc_error *error) {
    *mesh = nullptr;
    *seconds = 0;
    return without_exceptions(error, [=] { return decode(data, size, mesh, seconds, error); });
}
