#include "MetagraphShown.h"

#include "Animation/AnimCurveTypes.h"
#include "Animation/AnimInstance.h"
#include "BoneContainer.h"
#include "GameFramework/Actor.h"

void FMetagraphShown::TakeFrom(const UAnimInstance* Instance)
{
	const AActor* Owner = Instance ? Instance->GetOwningActor() : nullptr;
	const UMetagraphComponent* Component = Owner ? Owner->FindComponentByClass<UMetagraphComponent>() : nullptr;
	Take(Component ? Component->Pose() : nullptr);
}

void FMetagraphShown::Find(const FBoneContainer& Required)
{
	Places.Reset();
	if (!Pose.IsValid())
	{
		return;
	}
	for (const FName& Bone : Pose->Bones)
	{
		const int32 Place = Required.GetPoseBoneIndexForBoneName(Bone);
		const FCompactPoseBoneIndex Compact
			= Place == INDEX_NONE ? FCompactPoseBoneIndex(INDEX_NONE) : Required.MakeCompactPoseIndex(FMeshPoseBoneIndex(Place));
		Places.Add(Bone, Compact.GetInt());
	}
}

void FMetagraphShown::Apply(FPoseContext& Output, float Alpha, bool bBones, bool bCurves)
{
	if (!Pose.IsValid() || Alpha <= 0.0f)
	{
		return;
	}
	if (bBones && Places.Num() == 0)
	{
		Find(Output.Pose.GetBoneContainer());
	}
	for (int32 N = 0; bBones && N < Pose->Bones.Num(); N++)
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
	for (int32 N = 0; bCurves && N < Pose->Curves.Num(); N++)
	{
		const float Before = Alpha >= 1.0f ? 0.0f : Output.Curve.Get(Pose->Curves[N]);
		Output.Curve.Set(Pose->Curves[N], Before + (Pose->Weights[N] - Before) * (Alpha >= 1.0f ? 1.0f : Alpha));
		Output.Curve.SetFlags(Pose->Curves[N], UE::Anim::ECurveElementFlags::MorphTarget); // else the skeleton has to say so
	}
}
