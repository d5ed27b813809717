#include "AnimNode_Metagraph.h"

#include "Animation/AnimInstanceProxy.h"
#include "BoneContainer.h"

void FAnimNode_Metagraph::Initialize_AnyThread(const FAnimationInitializeContext& Context)
{
	FAnimNode_Base::Initialize_AnyThread(Context);
	BasePose.Initialize(Context);
}

void FAnimNode_Metagraph::CacheBones_AnyThread(const FAnimationCacheBonesContext& Context)
{
	BasePose.CacheBones(Context);
	Shown.Find(Context.AnimInstanceProxy->GetRequiredBones());
}

void FAnimNode_Metagraph::PreUpdate(const UAnimInstance* InAnimInstance)
{
	Shown.TakeFrom(InAnimInstance);
}

void FAnimNode_Metagraph::Update_AnyThread(const FAnimationUpdateContext& Context)
{
	GetEvaluateGraphExposedInputs().Execute(Context);
	BasePose.Update(Context);
}

void FAnimNode_Metagraph::Evaluate_AnyThread(FPoseContext& Output)
{
	BasePose.Evaluate(Output);
	Shown.Apply(Output, Alpha, bBones, bCurves);
}

void FAnimNode_Metagraph::GatherDebugData(FNodeDebugData& DebugData)
{
	DebugData.AddDebugItem(DebugData.GetNodeName(this));
	BasePose.GatherDebugData(DebugData);
}
