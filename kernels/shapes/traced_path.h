// A path as the stages behind the tracing ones find it in their queues.
#ifndef WAVELOBE_SHAPES_TRACED_PATH_H
#define WAVELOBE_SHAPES_TRACED_PATH_H

#include "core/block.h"
#include "shared/bvh.h"
#if HAS_LIGHT_TREE
#include "lights/receiver.h"
#endif

// A traced path as its queue holds it.
typedef struct {
    Float t, u, v;
    UInt hit, id, depth;
    Vec3 direction;
    Rgb throughput;
    Float pdf;
#if HAS_ANALYTIC
    Vec3 origin;
#endif
#if HAS_PATH_ETA
    Float eta;
#endif
#if HAS_INSTANCES
    UInt instance;
#endif
#if HAS_LIGHT_TREE
    ReceiverCode receiver;
#endif
#if HAS_MEDIA
    UInt medium;
#endif
    Int live; // lanes that hold a path
} TracedPath;

// Slots of a group beyond the queue's end are read as hits of triangle 0 with no weight.
INLINE TracedPath read_traced_path(Queue q, uint i) {
    TracedPath p;
    p.live = lanes_below(i, *q.count);
    p.t = read_field(q, PATH_T, i);
    p.hit = SELECT(p.live, read_uint(q, PATH_HIT, i), (UInt)0u);
    p.u = read_field(q, PATH_U, i);
    p.v = read_field(q, PATH_V, i);
    p.direction = read_vec3(q, PATH_DIRECTION, i);
    p.throughput = read_vec3(q, PATH_THROUGHPUT, i);
    p.pdf = read_field(q, PATH_PDF, i);
    p.id = SELECT(p.live, read_uint(q, PATH_ID, i), (UInt)0u);
    p.depth = read_uint(q, PATH_DEPTH, i);
#if HAS_ANALYTIC
    p.origin = read_vec3(q, PATH_ORIGIN, i);
#endif
#if HAS_PATH_ETA
    p.eta = read_field(q, PATH_ETA, i);
#endif
#if HAS_INSTANCES
    p.instance = SELECT(p.live, read_uint(q, PATH_INSTANCE, i), (UInt)INSTANCE_NONE);
#endif
#if HAS_LIGHT_TREE
    p.receiver.normal = read_uint(q, PATH_RECEIVER, i);
#if HAS_GLOSSY_RECEIVERS
    p.receiver.lobe = read_uint(q, PATH_RECEIVER + 1u, i);
#endif
#endif
#if HAS_MEDIA
    p.medium = SELECT(p.live, read_uint(q, PATH_MEDIUM, i), (UInt)0u);
#endif
    return p;
}

#endif
