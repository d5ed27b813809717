#pragma once

#include "CoreMinimal.h"
#include "Engine/DataAsset.h"
#include "MetagraphAsset.generated.h"

struct FMetagraphGraph;

/** An export: its JSON and its GLB as they were written, read once and shared by all components that play it. */
UCLASS(BlueprintType)
class METAGRAPH_API UMetagraphAsset : public UDataAsset
{
	GENERATED_BODY()

public:
	/** What the JSON was called, for messages. */
	UPROPERTY(VisibleAnywhere, Category = "Metagraph")
	FString SourceName;

	/** Where it was imported from, to import it again. */
	UPROPERTY(VisibleAnywhere, Category = "Metagraph")
	FString SourceFile;

	/** What is wrong with the export, or what it lacks; empty where nothing is. */
	UPROPERTY(VisibleAnywhere, Transient, Category = "Metagraph")
	FString Problem;

	/** Take an export's files. Returns whether they can be read; `Problem` says why not. */
	bool Take(const FString& Name, const TArray<uint8>& InJson, const TArray<uint8>& InGlb);

	/** The graph, read when it is first asked for; nothing where it cannot be read. On the game thread. */
	TSharedPtr<FMetagraphGraph> Graph();

private:
	UPROPERTY()
	TArray<uint8> Json;

	UPROPERTY()
	TArray<uint8> Glb;

	TSharedPtr<FMetagraphGraph> Read;
};
