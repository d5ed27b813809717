#pragma once

#include "CoreMinimal.h"
#include "Animation/AnimNodeBase.h"
#include "MetagraphComponent.h"

/** Shows a component's pose on a mesh: bones by name, and morph targets as animation curves. For one mesh, on any thread. */
struct METAGRAPH_API FMetagraphShown
{
	/** Take the latest pose of the actor's component. On the game thread. */
	void TakeFrom(const UAnimInstance* Instance);

	/** Take a pose. */
	void Take(TSharedPtr<const FMetagraphPose, ESPMode::ThreadSafe> InPose) { Pose = InPose; }

	/** Find where in the compact pose the bones are. */
	void Find(const FBoneContainer& Required);

	/** Put the pose into an animation's, as much of it as Alpha says. */
	void Apply(FPoseContext& Output, float Alpha, bool bBones, bool bCurves);

private:
	TSharedPtr<const FMetagraphPose, ESPMode::ThreadSafe> Pose;
	TMap<FName, int32> Places; // of bones in the compact pose
};
