#include "MetagraphAnimInstance.h"

#include "BoneContainer.h"

void FMetagraphAnimInstanceProxy::PreUpdate(UAnimInstance* InAnimInstance, float DeltaSeconds)
{
	FAnimInstanceProxy::PreUpdate(InAnimInstance, DeltaSeconds);
	Shown.TakeFrom(InAnimInstance);
}

void FMetagraphAnimInstanceProxy::CacheBones()
{
	FAnimInstanceProxy::CacheBones();
	Shown.Find(GetRequiredBones());
}

bool FMetagraphAnimInstanceProxy::Evaluate(FPoseContext& Output)
{
	Output.ResetToRefPose();
	Shown.Apply(Output, 1.0f, true, true);
	return true;
}

FAnimInstanceProxy* UMetagraphAnimInstance::CreateAnimInstanceProxy()
{
	return new FMetagraphAnimInstanceProxy(this);
}
