#pragma once

#include "CoreMinimal.h"
#include "Animation/AnimInstance.h"
#include "Animation/AnimInstanceProxy.h"
#include "MetagraphShown.h"
#include "MetagraphAnimInstance.generated.h"

/** What evaluates a UMetagraphAnimInstance, on any thread. */
USTRUCT()
struct METAGRAPH_API FMetagraphAnimInstanceProxy : public FAnimInstanceProxy
{
	GENERATED_BODY()

	FMetagraphAnimInstanceProxy() = default;
	explicit FMetagraphAnimInstanceProxy(UAnimInstance* Instance) : FAnimInstanceProxy(Instance) {}

	virtual void PreUpdate(UAnimInstance* InAnimInstance, float DeltaSeconds) override;
	virtual void CacheBones() override;
	virtual bool Evaluate(FPoseContext& Output) override;

private:
	FMetagraphShown Shown;
};

/**
 * Shows the pose of the actor's Metagraph component without an animation blueprint: the mesh's Anim Class. A component gives it to a
 * mesh that has none.
 */
UCLASS(Transient)
class METAGRAPH_API UMetagraphAnimInstance : public UAnimInstance
{
	GENERATED_BODY()

protected:
	virtual FAnimInstanceProxy* CreateAnimInstanceProxy() override;
};
