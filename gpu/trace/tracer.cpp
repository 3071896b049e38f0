// SPDX-License-Identifier: Apache-2.0
// Tracer: uploads rays to a buffer, runs the kernel over all of them, and reads their answers
// (gpu/trace/answers.h). Based on: thesis, section 3.1.
#include "gpu/trace/tracer.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/text/format_text.h"
#include "gpu/gl/gl_check.h"
#include "gpu/tuning/float_pair_check.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace ovc {
namespace {

constexpr uint32_t kMaxBlocks = 2048; // half a million rays; a pass gains nothing from more
constexpr uint32_t kMaxBlocksInSoftware = 512; // fewer, as llvmpipe clears the memory it allocates
constexpr uint32_t kMaxWordsInRegisters = 32;  // Workaround::ShortRegisterStack
// With words of 8 bytes in groups of 128 these are the 32 KiB that every device has.
constexpr uint32_t kMaxSharedWords = 32;
// If more than one ray in so many is lost, kernels go on longer. At plants-5 one in 160 to 260 took
// up to 5 % of the time of calls.
constexpr size_t kMaxLostShare = 512;
// The max rays of a lane in a share, if there are shares for so many lanes of each thread: 8 of the
// shares of 256 bits. With twice as many, calls of 4,096 rays take 4 % more time. Where that leaves
// a lane few rays, half the lanes take them, in half as many shares, each of which ends with lanes
// that wait for its last ray (docs/decisions/0012).
constexpr size_t kLaneRays = 128;
constexpr size_t kLanesAThread = 64;
constexpr size_t kFewLaneRays = 8;
constexpr size_t kLanesOfGpu = 65536;     // as many as a large GPU runs at once
constexpr uint64_t kSmallestPool = 16384; // a page of some hundred triangles

/// Returns how many rays a subgroup claims for each lane: whole packets.
size_t rays_a_lane(size_t rays, size_t packet, bool software) {
    static_assert(kBlockRays % (OVC_MAX_GROUP_SIZE * kPacketRays) == 0); // no packet across groups
    const size_t lanes = software ? kLanesAThread * thread_count() : kLanesOfGpu;
    size_t each = rays / packet / lanes;
    if (software && each < kFewLaneRays)
        each = rays / packet / (lanes / 2);
    return packet * std::clamp<size_t>(each, 1, kLaneRays / packet);
}

/// Frees the slot of a pass that is over when this goes, also where an exception ends it.
struct EndOfPass {
    PassSlot& slot;
    bool is_over = true;
    ~EndOfPass() {
        if (is_over)
            slot.sent = nullptr;
    }
};

/// Names to the driver's debuggers what is called while it lives.
struct DebugGroup {
    explicit DebugGroup(const char* name) {
        glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
    }
    ~DebugGroup() { glPopDebugGroup(); }
    DebugGroup(const DebugGroup&) = delete;
};

Result<Done> check_answers(const PassSlot& slot) {
    if (slot.is_complete())
        return Done{};
    return Error{"the driver cannot render to RGBA32UI textures, which answers come back in"};
}

} // namespace

Result<MemoryPlan> plan_memory(uint64_t budget_bytes, const DeviceInfo& device,
                               uint64_t bytes_per_ray, uint64_t buffer_bytes) {
    MemoryPlan plan;
    plan.bytes_per_ray = bytes_per_ray;
    plan.passes = device.passes_in_flight;
    plan.budget_bytes = budget_bytes;
    plan.batch_rays = kBlockRays;
    const uint64_t smallest = plan.ray_bytes() + kSmallestPool;
    if (budget_bytes < smallest)
        return over_budget(
            format_text("a GPU budget of {} bytes is too small: the smallest that works "
                        "is {} bytes ({} for rays and answers, {} for a page)",
                        budget_bytes, smallest, plan.ray_bytes(), kSmallestPool));
    // A pass's rays are read as one buffer texture.
    const uint64_t shown_blocks = device.max_buffer_texels / (OVC_RAY_TEXELS * kBlockRays);
    // An eighth for rays: batches of ten thousand and more already run at full speed, and pages
    // want the rest. The share is cut off whether whole blocks fill it or not, so that a larger
    // budget never has a smaller pool.
    MemoryPlan max_plan = plan;
    max_plan.batch_rays *= uint32_t(std::min<uint64_t>(
        {device.is_software ? kMaxBlocksInSoftware : kMaxBlocks / plan.passes,
         device.max_texture_size / OVC_TILE, std::max<uint64_t>(shown_blocks, 1)}));
    const uint64_t ray_share = std::clamp(budget_bytes / 8, plan.ray_bytes(), max_plan.ray_bytes());
    plan.batch_rays *= uint32_t(ray_share / plan.ray_bytes());
    while (plan.ray_bytes() > ray_share)
        plan.batch_rays -= kBlockRays;
    plan.pool_bytes =
        (budget_bytes - ray_share) / device.buffer_alignment * device.buffer_alignment;
    plan.buffer_bytes = device.max_buffer_texels * sizeof(uvec4);
    if (buffer_bytes > 0)
        plan.buffer_bytes = std::min(plan.buffer_bytes, buffer_bytes);
    plan.pool_bytes = std::min(plan.pool_bytes, plan.buffer_bytes * device.max_pool_buffers);
    // A further buffer costs every step of a ray, so it is worth it only if it holds some pages.
    const uint64_t rest = plan.pool_bytes % plan.buffer_bytes;
    if (plan.pool_bytes > plan.buffer_bytes && rest < plan.buffer_bytes / 4)
        plan.pool_bytes -= rest;
    return plan;
}

Tracer::Tracer(std::unique_ptr<Ledger> ledger, const MemoryPlan& plan, const PassOptions& options,
               const DeviceInfo& device, KernelCache& kernels, const Box& bounds,
               std::span<const Page> pages, const TopLevel& top)
    : ledger_(std::move(ledger)),
      kernels_(kernels),
      options_(options),
      page_data_(pages),
      device_(device),
      top_(top),
      all_fit_(ovc::all_fit(pages, plan.pool(), top.room())),
      scene_(top.scene_in(bounds)),
      stack_depth_(stack_depth(top.depth)),
      uploads_(device.passes_in_flight > 1, plan.pool_bytes + plan.ray_bytes()),
      pool_(*ledger_, uploads_, plan.pool(), pages.size(), top.room()) {
    const KernelVariant variant =
        options.variants[RayKind{.frames = RayKind::frames_of(top.portals.size())}];
    for (uint32_t i = 0; i < plan.passes; ++i)
        slots_.emplace_back(*ledger_, plan.batch_rays, plan.parted_rays())
            .make_answers(*ledger_, variant.compute, device_.passes_in_flight > 1);
    if (top.table_bytes() > 0)
        portal_buffer_.emplace(*ledger_, top.table_bytes(), "portals");
    if (plan.active_bytes > 0)
        active_buffer_.emplace(*ledger_, plan.active_bytes, "active leaves");
}

Tracer::~Tracer() {
    // A pass that could not be collected may still read buffers that lie in this process's own
    // pages.
    if (device_.takes_host_pages && generation_ == gl::context_generation)
        glFinish();
}

/// Does the setup that needs the memory to be allocated.
Result<Done> Tracer::set_up() {
    const Result<Done> allocated = check_gl("allocating the page pool and the buffers of rays");
    if (ledger_->refused) // GL's own error then only follows from that
        return Error{"the GPU is out of memory", ErrorKind::OutOfGpuMemory};
    if (!allocated)
        return allocated;
    if (portal_buffer_)
        portals_.show(*portal_buffer_, GL_RGBA32UI, 0, portal_buffer_->bytes());
    for (PassSlot& slot : slots_)
        slot.rays.show(slot.ray_buffer, GL_RGBA32UI, 0, slot.ray_buffer.bytes());
    pool_.show();
    upload_top_level();
    if (active_buffer_) {
        active_.show(*active_buffer_, GL_R32UI, 0, active_buffer_->bytes());
        take_active(); // clears it
    }
    for (const PassSlot& slot : slots_)
        if (const Result<Done> drawn = check_answers(slot); !drawn)
            return drawn;
    return check_gl("setting up the tracer");
}

Result<std::unique_ptr<Tracer>> Tracer::create(const MemoryPlan& plan, const PassOptions& options,
                                               const DeviceInfo& device, KernelCache& kernels,
                                               const Box& bounds, std::span<const Page> pages,
                                               const TopLevel& top) {
    assert(is_usable(top, pages, plan.pool()));
    auto ledger = std::make_unique<Ledger>();
    ledger->budget = plan.budget_bytes;
    ledger->driver_bytes = plan.driver_bytes;
    ledger->takes_host_pages = device.takes_host_pages;
    std::unique_ptr<Tracer> tracer(
        new Tracer(std::move(ledger), plan, options, device, kernels, bounds, pages, top));
    if (Result<Done> ok = tracer->set_up(); !ok)
        return ok.error();
    return tracer;
}

/// Returns the unit of the pool that a link to the page leads to now.
uint32_t Tracer::way_to(uint32_t leaf, const Link& link) const {
    const uint32_t page = uint32_t(pool_.residency().slot(leaf).offset / OVC_UNIT_BYTES);
    return resident(leaf) ? page + link.first_child : OVC_LEADS_NOWHERE;
}

/// Tells the kernel where a page is now, by writing to the page's links.
void Tracer::say_where(uint32_t leaf) {
    for (const Link& link : top_.links_of(leaf)) {
        const uint64_t texel = uint64_t(link.unit) * OVC_UNIT_TEXELS + 3;
        pool_.write(texel * sizeof(uvec4), way_to(leaf, link));
    }
}

/// Writes the tree, whose links lead to the pages where these are now, and the table of portals.
void Tracer::upload_top_level() {
    Page tree = top_.tree;
    for (uint32_t leaf = 0; leaf < page_data_.size(); ++leaf)
        for (const Link& link : top_.links_of(leaf))
            tree.texels[size_t(link.unit) * OVC_UNIT_TEXELS + 3].x = way_to(leaf, link);
    pool_.upload(0, tree.view());
    if (!has_portals())
        return;
    const std::vector<uvec4> table = pack_portals(top_.portals);
    glNamedBufferSubData(portal_buffer_->id(), 0, GLsizeiptr(table.size() * sizeof(uvec4)),
                         table.data());
}

bool Tracer::update(const Box& bounds, std::span<const Page> pages, std::span<const uint32_t> was,
                    std::span<const uint32_t> changed) {
    assert(pages.size() == was.size());
    const uint64_t table_bytes = portal_buffer_ ? portal_buffer_->bytes() : 0;
    if (top_.tree.bytes() > pool_.begin() || top_.used_table_bytes() > table_bytes ||
        (active_buffer_ && pages.size() * sizeof(uint32_t) != active_buffer_->bytes()))
        return false;
    page_data_ = pages;
    Residency& residency = pool_.residency();
    residency.renumber(was);
    for (const uint32_t leaf : changed) {
        if (!resident(leaf))
            continue;
        const auto [offset, bytes] = residency.slot(leaf);
        if (bytes == pages[leaf].bytes())
            pool_.upload(offset, pages[leaf].view(), uint32_t(offset / OVC_UNIT_BYTES));
        else
            residency.evict(leaf);
    }
    scene_ = top_.scene_in(bounds);
    all_fit_ = ovc::all_fit(pages, pool_.layout(), pool_.begin());
    stack_depth_ = stack_depth(top_.depth);
    min_stack_words_ = 0;
    upload_top_level();
    return bool(check_gl("updating pages"));
}

std::vector<uint32_t> Tracer::missing() const {
    std::vector<uint32_t> leaves;
    for (uint32_t leaf = 0; leaf < page_data_.size(); ++leaf)
        if (!resident(leaf))
            leaves.push_back(leaf);
    return leaves;
}

Moved Tracer::bring(std::span<const uint32_t> wanted) {
    return bring(wanted, [this](uint32_t leaf, FunctionRef<void(std::span<const uvec4>)> take) {
        take(page_data_[leaf].view());
    });
}

Moved Tracer::bring(std::span<const uint32_t> wanted, const GivePage& give) {
    if (wanted.empty())
        return {};
    Moved moved;
    std::vector<uint32_t> evicted;
    const uint64_t keep = pool_.residency().now();
    for (const uint32_t leaf : wanted) {
        assert(leaf < page_data_.size());
        bool is_in = false;
        give(leaf, [&](std::span<const uvec4> units) {
            assert(units.size_bytes() == page_data_[leaf].bytes());
            is_in = pool_.residency().admit(leaf, units.size_bytes(), keep, evicted);
            if (!is_in)
                return;
            const uint64_t offset = pool_.residency().slot(leaf).offset;
            pool_.upload(offset, units, uint32_t(offset / OVC_UNIT_BYTES));
        });
        if (!is_in)
            break;
        say_where(leaf);
        moved.pages += 1;
        moved.bytes += page_data_[leaf].bytes();
    }
    for (const uint32_t leaf : evicted)
        say_where(leaf);
    return moved;
}

bool Tracer::can_read_as(const KernelVariant& variant) const {
    const PoolLayout& layout = pool_.layout();
    uint64_t largest = slots_[0].ray_buffer.bytes();
    for (uint32_t i = 0; i < layout.count(); ++i)
        largest = std::max(largest, layout.bytes_of(i));
    return can_read(device_, variant, layout.count(), largest);
}

bool Tracer::can_run(const KernelVariant& variant) const {
    return can_read_as(variant) && (!variant.float_pairs || takes_float_pairs());
}

/// Whether kernels can change frames in pairs of floats. Rays that wait cannot: their resume keys
/// must be the same bits in every pass.
bool Tracer::takes_float_pairs() const {
    if (!has_portals() || !options_.certify || may_wait())
        return false;
    if (!keeps_float_pairs_)
        keeps_float_pairs_ = driver_keeps_float_pairs();
    return *keeps_float_pairs_;
}

void Tracer::begin_to_compile(const KernelVariant& variant) {
    kernels_.begin(shader_config(kind_, variant));
}

bool Tracer::is_ready(const KernelVariant& variant) const {
    return kernels_.is_ready(shader_config(kind_, variant));
}

RayForm Tracer::form() const {
    const auto kind = has_portals() ? RayForm::Kind::World
                      : may_wait()  ? RayForm::Kind::Resumed
                                    : RayForm::Kind::Local;
    return {kind, &scene_, top_.way_in ? &*top_.way_in : nullptr};
}

/// Returns how many words the kernel's stack has.
uint32_t Tracer::stack_words(const KernelVariant& variant) const {
    const uint32_t words = std::max(variant.stack_words, min_stack_words_);
    return variant.stack_words > 0 ? std::min(stack_depth_, words) : stack_depth_;
}

/// Returns where the kernel's stack of so many words lies.
StackPlace Tracer::stack_place(const KernelVariant& variant, uint32_t words) const {
    const bool fits = variant.stack == StackPlace::Shared
                          ? words <= kMaxSharedWords
                          : words <= kMaxWordsInRegisters || !registers_lose_words_;
    return fits ? variant.stack : StackPlace::Array;
}

/// Returns the configuration of the kernel for rays of a kind.
ShaderConfig Tracer::shader_config(RayKind kind, const KernelVariant& variant) const {
    ShaderConfig config;
    config.any_hit = kind.any_hit;
    config.certify = options_.certify;
    config.counts = options_.counts;
    config.portals = has_portals();
    config.float_pairs = variant.float_pairs && takes_float_pairs();
    config.may_wait = may_wait();
    config.tell_active = active_buffer_.has_value();
    config.pool_buffers = pool_.layout().count();
    config.buffer_bits = pool_.layout().buffer_bits();
    config.loose_pairs = std::ranges::any_of(page_data_, &Page::has_loose_pairs);
    if (counts_rounds_)
        config.max_rounds = kMaxCountedRounds;
    config.compute = variant.compute;
    config.stack_depth = stack_words(variant);
    config.stack = stack_place(variant, config.stack_depth);
    config.branches = variant.branches;
    config.reads = variant.reads;
    config.group_size = variant.group_size;
    config.packet = packs(kind, variant) ? kPacketRays : 1;
    config.claims = claims(variant);
    config.refill = config.claims && variant.refill;
    return config;
}

/// Whether subgroups claim their rays. A GPU gives groups to whatever part of it is free, and a
/// lane counts the units of one ray.
bool Tracer::claims(const KernelVariant& variant) const {
    return variant.compute && !gives_rays_all_rounds_ && !options_.counts &&
           (variant.refill || (device_.is_software && device_.can_refill()));
}

Result<Tracer::Pass> Tracer::submit(SentRays& rays) {
    assert(rays.size() > 0);
    const auto free = std::ranges::find(slots_, nullptr, &PassSlot::sent);
    assert(free != slots_.end());
    PassSlot& slot = *free;
    rays.unpart();
    slot.kind = {.any_hit = rays.all_any_hit(), .frames = RayKind::frames_of(top_.portals.size())};
    slot.kind.coherent = rays.are_coherent();
    slot.variant = options_.variants[slot.kind];
    slot.packets = packs(slot.kind, slot.variant) && rays.part(slot.max_slots);
    slot.kernel_seconds = 0;
    slot.sent = &rays;
    EndOfPass end{slot};
    slot.make_answers(*ledger_, slot.variant.compute, device_.passes_in_flight > 1);
    Result<Done> done = check_answers(slot);
    if (done)
        done = launch(slot);
    if (!done)
        return done.error();
    end.is_over = false;
    return size_t(free - slots_.begin());
}

/// Where the driver compiles a kernel beside this thread, it is given the one for any hit, or for
/// the nearest, as well: most hosts ask for both, and it can compile them at the same time.
void Tracer::begin_to_compile_both(RayKind kind, const ShaderConfig& config) {
    if (device_.is_software)
        return;
    kernels_.begin(config);
    if (kernels_.is_ready(config))
        return;
    kind.any_hit = !kind.any_hit;
    kernels_.begin(shader_config(kind, options_.variants[kind]));
}

/// Brings the rays to the kernel. Each time, because a kernel may write names in the places of rays
/// that were copied. In place only where a pass is over when launch() returns.
void Tracer::show_rays(PassSlot& slot) {
    const std::span<const std::byte> rays = slot.sent->bytes();
    if (!device_.takes_host_pages || device_.passes_in_flight > 1)
        return uploads_.copy(rays, slot.ray_buffer);
    slot.rays_in_place.emplace(rays);
    slot.rays.show(slot.rays_in_place->id(), GL_RGBA32UI, 0, rays.size());
}

Result<Done> Tracer::launch(PassSlot& slot) {
    ShaderConfig config = shader_config(slot.kind, slot.variant);
    config.packet = slot.packets ? kPacketRays : 1; // not where too many rays had to be parted
    slot.stack_words = config.stack_depth;
    begin_to_compile_both(slot.kind, config);
    const Result<GLuint> program = kernels_.program(config);
    if (!program)
        return program.error();
    show_rays(slot);

    const DebugGroup group("pass");
    glUseProgram(*program);
    pool_.bind(config.reads);
    slot.rays.bind(OVC_BINDING_RAYS, config.reads);
    if (config.compute)
        glBindImageTexture(OVC_BINDING_NAMES, slot.name_words.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY,
                           GL_R32UI);
    if (has_portals())
        portals_.bind(OVC_BINDING_PORTALS, config.reads);
    if (config.tell_active)
        glBindImageTexture(OVC_BINDING_ACTIVE, active_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY,
                           GL_R32UI);
    size_t group_rays = size_t(config.group_size) * config.packet;
    size_t lane_rays = 0;
    if (config.claims) {
        lane_rays = rays_a_lane(slot.sent->slots(), config.packet, device_.is_software);
        group_rays = config.group_size * lane_rays;
    }
    const Stopwatch watch;
    if (device_.is_software)
        driver_threads_.start();
    else
        glBeginQuery(GL_TIME_ELAPSED, slot.time.id());
    if (slot.words)
        slot.words->dispatch(*program, slot.sent->slots(), group_rays, lane_rays);
    else
        slot.pixels->draw(slot.sent->size());
    if (!device_.is_software)
        glEndQuery(GL_TIME_ELAPSED);
    if (slot.words)
        slot.words->begin_read(slot.sent->slots(), may_wait());
    else
        slot.pixels->begin_read(slot.sent->size());
    if (device_.passes_in_flight == 1)
        glFinish();
    else
        glFlush();
    if (device_.is_software)
        slot.kernel_seconds += driver_threads_.seconds_each().value_or(watch.seconds());
    return check_gl("starting a pass");
}

std::vector<uint32_t> Tracer::take_active() {
    if (!active_buffer_)
        return {};
    std::vector<uint32_t> active(active_buffer_->bytes() / sizeof(uint32_t));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(active_buffer_->id(), 0, GLsizeiptr(active_buffer_->bytes()),
                            active.data());
    const uint32_t none = 0;
    glClearNamedBufferData(active_buffer_->id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &none);
    return active;
}

void Tracer::read(PassSlot& slot, Answers& answers) {
    if (slot.words)
        slot.words->read(answers, slot.sent->slots());
    else
        slot.pixels->read(answers, slot.sent->size());
    if (slot.words)
        read_lists(slot, answers);
    for (const auto& [ray, from] : slot.sent->parted())
        answers.move(ray, from);
    if (!device_.is_software)
        slot.kernel_seconds += slot.time.seconds();
}

/// Reads the places of rays with names in them: whole blocks, as many as follow each other.
void Tracer::read_lists(const PassSlot& slot, Answers& answers) {
    const size_t slots = slot.sent->slots();
    const size_t ray_bytes = slot.sent->bytes().size() / whole_blocks(slots);
    answers.ray_texels = ray_bytes / sizeof(uvec4);
    const auto has_lists = [&](size_t first) {
        for (size_t i = first; i < std::min(first + kBlockRays, slots); ++i)
            if (answers.is_listed(i))
                return true;
        return false;
    };
    for (size_t first = 0; first < slots; first += kBlockRays) {
        size_t last = first;
        while (last < slots && has_lists(last))
            last += kBlockRays;
        if (last == first)
            continue;
        answers.lists.resize(std::max(answers.lists.size(), last * answers.ray_texels));
        uvec4* const to = &answers.lists[first * answers.ray_texels];
        const size_t bytes = (last - first) * ray_bytes;
        if (slot.names)
            std::memcpy(to, slot.names->memory().data() + first * ray_bytes, bytes);
        else
            glGetNamedBufferSubData(slot.ray_buffer.id(), GLintptr(first * ray_bytes),
                                    GLsizeiptr(bytes), to);
        first = last;
    }
}

/// Whether the kernel gave up many rays, which matters because doubles decide a ray slower than a
/// pass does.
bool Tracer::lost_many(const Answers& answers, size_t rays) {
    const auto lost =
        std::count_if(answers.names.begin(), answers.names.begin() + ptrdiff_t(rays),
                      [](uint32_t name) { return (name & ~OVC_SAYS_MORE) == OVC_CAPPED; });
    return size_t(lost) > rays / kMaxLostShare;
}

/// Makes later kernels give up fewer rays than that of the pass: first by a stack half as long
/// again, then by giving each ray all the rounds there are. Returns false if they already give up
/// as few as possible.
bool Tracer::go_on_longer(const PassSlot& slot) {
    if (slot.stack_words < stack_depth_) {
        min_stack_words_ =
            std::max(min_stack_words_, slot.stack_words + (slot.stack_words + 1) / 2);
        return true;
    }
    return claims(slot.variant) && !std::exchange(gives_rays_all_rounds_, true);
}

bool Tracer::are_passes_under_way() const {
    return std::ranges::any_of(slots_, [](const PassSlot& slot) { return slot.sent; });
}

Result<Done> Tracer::collect(Pass pass, Answers& answers) {
    PassSlot& slot = slots_[pass];
    assert(slot.sent);
    const EndOfPass end{slot};
    return collect(slot, answers);
}

Result<Done> Tracer::collect(PassSlot& slot, Answers& answers) {
    kind_ = slot.kind;
    read(slot, answers);
    while (lost_many(answers, slot.sent->size()) && go_on_longer(slot)) {
        // If all pages fit they stay in place. Otherwise pages may have been evicted since the
        // pass.
        if (!all_fit_)
            break;
        if (Result<Done> ok = launch(slot); !ok)
            return ok;
        read(slot, answers);
    }
    kernel_seconds_ = slot.kernel_seconds;
    return check_gl("reading the answers of a pass");
}

Result<Done> Tracer::trace(SentRays& rays, Answers& answers) {
    const Result<Pass> pass = submit(rays);
    return pass ? collect(*pass, answers) : pass.error();
}

} // namespace ovc
