#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/mpi/rank_link.h"
#include "host/worker_pool/worker_parts.h"

namespace emax {

// Steps of parts on the ranks of a job: each rank, rank 0 too, runs as many at a time as it has
// processors, or options.jobs of them. All ranks need the folder under the same name. The link must
// outlive what is returned, which throws Error also where another rank cannot run a part.
RunParts rank_parts(RankLink& link, std::vector<unsigned> processors,
                    std::vector<std::string> hosts, const std::filesystem::path& folder,
                    const WorkerPartsOptions& options);

}  // namespace emax
