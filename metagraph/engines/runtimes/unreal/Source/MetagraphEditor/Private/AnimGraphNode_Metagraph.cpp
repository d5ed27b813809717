#include "AnimGraphNode_Metagraph.h"

#define LOCTEXT_NAMESPACE "Metagraph"

FText UAnimGraphNode_Metagraph::GetNodeTitle(ENodeTitleType::Type) const
{
	return LOCTEXT("Title", "Metagraph");
}

FText UAnimGraphNode_Metagraph::GetTooltipText() const
{
	return LOCTEXT("Tooltip", "Shows the pose of the actor's Metagraph component");
}

FString UAnimGraphNode_Metagraph::GetNodeCategory() const
{
	return FString(TEXT("Metagraph"));
}

#undef LOCTEXT_NAMESPACE
