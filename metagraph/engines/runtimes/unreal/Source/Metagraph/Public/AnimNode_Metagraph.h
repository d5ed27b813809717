#pragma once

#include "CoreMinimal.h"
#include "Animation/AnimNodeBase.h"
#include "MetagraphShown.h"
#include "AnimNode_Metagraph.generated.h"

/** Shows the pose of the actor's Metagraph component. Bones the export does not have stay as the input has them. */
USTRUCT(BlueprintInternalUseOnly)
struct METAGRAPH_API FAnimNode_Metagraph : public FAnimNode_Base
{
	GENERATED_BODY()

	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = Links)
	FPoseLink BasePose;

	/** How much of it shows, 0 to 1. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = Settings, meta = (PinShownByDefault, ClampMin = "0", ClampMax = "1"))
	float Alpha = 1.0f;

	/** Whether bones move. Off for a face whose bones another rig moves, as a MetaHuman's. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = Settings)
	bool bBones = true;

	/** Whether morph targets become animation curves of their names, which are ARKit's if the export's are. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = Settings)
	bool bCurves = true;

	virtual void Initialize_AnyThread(const FAnimationInitializeContext& Context) override;
	virtual void CacheBones_AnyThread(const FAnimationCacheBonesContext& Context) override;
	virtual void Update_AnyThread(const FAnimationUpdateContext& Context) override;
	virtual void Evaluate_AnyThread(FPoseContext& Output) override;
	virtual void GatherDebugData(FNodeDebugData& DebugData) override;

	// The one moment on the game thread: the pose is taken here.
	virtual bool HasPreUpdate() const override { return true; }
	virtual void PreUpdate(const UAnimInstance* InAnimInstance) override;

	/** Take a pose to be shown; what PreUpdate does. */
	void Take(TSharedPtr<const FMetagraphPose, ESPMode::ThreadSafe> InPose) { Shown.Take(InPose); }

private:
	FMetagraphShown Shown;
};
