flat in float covered;

layout(location = 0) out float entry;

void main()
{
    entry = covered;
}
