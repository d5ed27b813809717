#include "MetagraphAsset.h"

#include "MetagraphCore.h"

bool UMetagraphAsset::Take(const FString& Name, const TArray<uint8>& InJson, const TArray<uint8>& InGlb)
{
	SourceName = Name;
	Json = InJson;
	Glb = InGlb;
	Read.Reset();
	return Graph().IsValid();
}

TSharedPtr<FMetagraphGraph> UMetagraphAsset::Graph()
{
	if (Read.IsValid())
	{
		return Read;
	}
	const std::string Text(reinterpret_cast<const char*>(Json.GetData()), static_cast<std::size_t>(Json.Num()));
	const metagraph::Loaded Loaded
		= metagraph::load(Text, Glb.GetData(), static_cast<std::size_t>(Glb.Num()), MetagraphText::Plain(SourceName));
	if (!Loaded.graph)
	{
		Problem = MetagraphText::Unreal(Loaded.error);
		UE_LOG(LogTemp, Error, TEXT("Metagraph: %s"), *Problem);
		return nullptr;
	}
	Problem = MetagraphText::Unreal(metagraph::lang::joined(Loaded.graph->problems, "; "));
	Read = MakeShared<FMetagraphGraph>();
	Read->Graph = Loaded.graph;
	return Read;
}
