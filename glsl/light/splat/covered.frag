// A photon's entry in the table of what kernels cover.
flat in float covered;

// Area in scene units, weighted; 0 for a photon that does not contribute.
layout(location = 0) out float entry;

void main()
{
    entry = covered;
}
