#pragma once

#include "AnimGraphNode_Base.h"
#include "AnimNode_Metagraph.h"
#include "CoreMinimal.h"
#include "AnimGraphNode_Metagraph.generated.h"

/** The node "Metagraph" of animation blueprints. */
UCLASS()
class METAGRAPHEDITOR_API UAnimGraphNode_Metagraph : public UAnimGraphNode_Base
{
	GENERATED_BODY()

public:
	UPROPERTY(EditAnywhere, Category = Settings)
	FAnimNode_Metagraph Node;

	virtual FText GetNodeTitle(ENodeTitleType::Type TitleType) const override;
	virtual FText GetTooltipText() const override;
	virtual FString GetNodeCategory() const override;
};
