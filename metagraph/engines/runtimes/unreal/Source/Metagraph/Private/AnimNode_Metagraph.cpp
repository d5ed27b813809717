#include "AnimNode_Metagraph.h"

#include "Animation/AnimInstance.h"
#include "Animation/AnimInstanceProxy.h"
#include "BoneContainer.h"
#include "GameFramework/Actor.h"

void FAnimNode_Metagraph::Initialize_AnyThread(const FAnimationInitializeContext& Context)
{
	FAnimNode_Base::Initialize_AnyThread(Context);
	BasePose.Initialize(Context);
}

void FAnimNode_Metagraph::CacheBones_AnyThread(const FAnimationCacheBonesContext& Context)
{
	BasePose.CacheBones(Context);
	Places.Reset();
	if (Pose.IsValid())
	{
		Find(Context.AnimInstanceProxy->GetRequiredBones());
	}
}

void FAnimNode_Metagraph::PreUpdate(const UAnimInstance* InAnimInstance)
{
	const AActor* Owner = InAnimInstance ? InAnimInstance->GetOwningActor() : nullptr;
	const UMetagraphComponent* Component = Owner ? Owner->FindComponentByClass<UMetagraphComponent>() : nullptr;
	Take(Component ? Component->Pose() : nullptr);
}

void FAnimNode_Metagraph::Update_AnyThread(const FAnimationUpdateContext& Context)
{
	GetEvaluateGraphExposedInputs().Execute(Context);
	BasePose.Update(Context);
}

/** Find where in the compact pose the export's bones are. */
void FAnimNode_Metagraph::Find(const FBoneContainer& Required)
{
	for (const FName& Bone : Pose->Bones)
	{
		const int32 Place = Required.GetPoseBoneIndexForBoneName(Bone);
		const FCompactPoseBoneIndex Compact
			= Place == INDEX_NONE ? FCompactPoseBoneIndex(INDEX_NONE) : Required.MakeCompactPoseIndex(FMeshPoseBoneIndex(Place));
		Places.Add(Bone, Compact.GetInt());
	}
}

void FAnimNode_Metagraph::Evaluate_AnyThread(FPoseContext& Output)
{
	BasePose.Evaluate(Output);
	if (!Pose.IsValid() || Alpha <= 0.0f)
	{
		return;
	}
	if (Places.Num() == 0)
	{
		Find(Output.Pose.GetBoneContainer());
	}
	for (int32 N = 0; N < Pose->Bones.Num(); N++)
	{
		const int32* Place = Places.Find(Pose->Bones[N]);
		if (Place == nullptr || *Place == INDEX_NONE)
		{
			continue; // the mesh does not have it, or not at this level of detail
		}
		FTransform& Bone = Output.Pose[FCompactPoseBoneIndex(*Place)];
		FTransform Wanted = Pose->Transforms[N];
		Wanted.SetScale3D(Bone.GetScale3D());
		if (Alpha >= 1.0f)
		{
			Bone = Wanted;
		}
		else
		{
			Bone.BlendWith(Wanted, Alpha);
		}
	}
}

void FAnimNode_Metagraph::GatherDebugData(FNodeDebugData& DebugData)
{
	DebugData.AddDebugItem(DebugData.GetNodeName(this));
	BasePose.GatherDebugData(DebugData);
}
